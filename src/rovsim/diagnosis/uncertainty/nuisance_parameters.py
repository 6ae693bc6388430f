"""What a fit would not know if further parameters were free, to first order.

With H the information about all of them, s those fitted and n the further ones: the fitted follow
by A = -H_ss^-1 H_sn where the further ones are not what was assumed, and the runs tell
H_nn + H_ns A of these (Schur's complement).
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import as_rows, gram, solve
from rovsim.estimation.observer.observed_run import ObservedRun


@dataclass(frozen=True, eq=False)
class LeftOpen:
    """How the fitted (k,) follow further parameters (n,), `along` (k, n), all scaled.

    The runs give these `information` (n, n) and a `score` (n,); information^-1 score is likeliest.
    """

    along: Array
    information: Array
    score: Array


def leave_open(fit: Fit, freed: Hypothesis, runs: Sequence[ObservedRun]) -> LeftOpen | None:
    """What is open with more parameters free; None where the observer cannot hold such a model."""
    bank = FilterBank.design(runs, fit.hypothesis.model, fit.noise)
    seen = bank.linearise(freed)
    if not seen.finite:
        return None
    names, fitted = freed.parameter_names, fit.hypothesis.parameter_names
    s = [names.index(name) for name in fitted]
    n = [k for k, name in enumerate(names) if name not in fitted]
    J, e = bank.whiten(seen.J, fit.noise), bank.whiten(seen.e, fit.noise)
    rows = as_rows(J)
    H, slope = gram(rows), rows @ e.ravel()
    along = -solve(H[np.ix_(s, s)], H[np.ix_(s, n)])
    return LeftOpen(along, H[np.ix_(n, n)] + H[n][:, s] @ along, -slope[n] - along.T @ slope[s])
