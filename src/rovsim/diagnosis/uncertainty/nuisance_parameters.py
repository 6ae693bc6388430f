"""How much less sure a fit would be if further parameters were free, to first order.

Let H be the information about all parameters, s the fitted ones and n the further ones. If the
further ones differ from what was assumed, the fitted ones follow by A = -H_ss^-1 H_sn. The runs
hold the information H_nn + H_ns A about the further ones (Schur's complement).
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
class NuisanceParameters:
    """n further parameters beside k fitted ones, all scaled.

    Attributes:
        along: how the fitted ones follow the further ones (k, n).
        information: of the runs about the further ones (n, n).
        score: slope (n,) of the log likelihood; their likeliest change is information^-1 score.
    """

    along: Array
    information: Array
    score: Array


def free_nuisance(
    fit: Fit, freed: Hypothesis, runs: Sequence[ObservedRun]
) -> NuisanceParameters | None:
    """Linearise a fit with further parameters free; None where such a model diverges.

    Args:
        fit: with its k parameters.
        freed: the same hypothesis with n further parameters free.
        runs: that it was fitted to.
    """
    bank = FilterBank.design(runs, fit.hypothesis.model, fit.noise)
    linearised = bank.linearise_centrally(freed)
    if not linearised.is_finite:
        return None
    names, selected_names = freed.parameter_names, fit.hypothesis.parameter_names
    s = [names.index(name) for name in selected_names]
    n = [k for k, name in enumerate(names) if name not in selected_names]
    J, e = bank.whiten(linearised.J, fit.noise), bank.whiten(linearised.e, fit.noise)
    rows = as_rows(J)
    H, slope = gram(rows), rows @ e.ravel()
    along = -solve(H[np.ix_(s, s)], H[np.ix_(s, n)])
    return NuisanceParameters(
        along, H[np.ix_(n, n)] + H[n][:, s] @ along, -slope[n] - along.T @ slope[s]
    )
