"""Accepted effects that nothing asks for once an effect has another value in each run.

A search that knows one value for all runs takes others to make up for what differs: where the
battery of one run of three was low, added masses and a force of the surface that were not there
made the error on the test run 2.5 times the nominal one.
"""

from functools import partial
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.checks.by_run import group_runs
from rovsim.diagnosis.checks.run_differences import RunDifference, linearise_term
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.least_squares import as_rows, gram, newton_step

MIN_SPREAD = 1e-9  # of whitened innovations, whose usual spread is 1: an axis that nothing moves


def find_needless(
    fit: Fit, bank: FilterBank, difference: RunDifference, penalty: float
) -> str | None:
    """Id of the accepted effect that is least worth its penalties beside a difference.

    Without it, all others are fitted anew, to first order, and the one that differs to each run by
    itself. What noise there is follows from what all of them leave.

    Args:
        fit: of all accepted effects, at values common to all runs.
        bank: of that fit.
        difference: an effect that has another value in each run.
        penalty: of each free parameter.

    Returns:
        The id; None where all are worth it.
    """
    accepted, whiten = fit.hypothesis, partial(bank.whiten, noise=fit.noise)
    J = whiten(fit.linearised.J)
    common = {
        term.id: (k, J[own])
        for k, (term, own) in enumerate(zip(accepted.terms, accepted.columns, strict=True))
        if term.id != difference.effect_id
    }
    by_run = whiten(_differentiate_by_run(fit, bank, difference))
    e = whiten(fit.linearised.e)
    left = _explain(e, [by_run, *(rows for _, rows in common.values())])
    spread = np.maximum(np.std(left, axis=1, keepdims=True), MIN_SPREAD)
    least, worth = np.sum(np.square(left / spread)), {}
    for name, (k, _) in common.items():
        without = whiten(bank.innovations(accepted.without(k).model))
        others = [rows for other, (_, rows) in common.items() if other != name]
        rest = _explain(without / spread, [x / spread for x in (by_run, *others)])
        worth[name] = np.sum(np.square(rest)) - least - penalty * accepted.terms[k].choices
    weakest = min(worth, key=worth.__getitem__, default=None)
    return weakest if weakest and worth[weakest] < 0.0 else None


def _differentiate_by_run(fit: Fit, bank: FilterBank, difference: RunDifference) -> list[Array]:
    """Derivatives (R k, 6, n) of each part to the values of R runs, zero to those of others."""
    term = next(iter(difference.by_run.values())).term
    rows = linearise_term(fit, term, bank)
    owners = list(group_runs(bank.runs).values())
    return [
        np.concatenate([part if k in own else np.zeros_like(part) for own in owners])
        for k, part in enumerate(rows)
    ]


def _explain(e: Array, columns: Sequence[Array]) -> Array:
    """What columns (.., 6, n) leave of innovations (6, n), at their best."""
    rows = np.concatenate([e[None], *columns])
    step = newton_step(gram(as_rows(rows)))
    return np.asarray(e + np.tensordot(step, rows[1:], axes=1))
