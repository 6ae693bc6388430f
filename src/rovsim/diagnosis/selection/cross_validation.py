"""Does an effect also help where it was not fitted? Cross-validation by blocks of time."""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.least_squares import as_rows, gram, newton_step
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import number_blocks

FOLDS = 6  # each leaves out every sixth block of time


def drop_idle(selection: SearchResult) -> SearchResult:
    """Remove effects that do not help on held-out blocks, or that no user would notice."""
    workspace, fit = selection.workspace, selection.best
    while fit.hypothesis.terms:
        reduced = [fit.hypothesis.without(i) for i in range(len(fit.hypothesis.terms))]
        fits = [workspace.fit(h) for h in reduced]
        noticed = workspace.find_relevant(fit, [h.model for h in reduced])
        idle = [
            h
            for h, relevant, smaller_fit in zip(reduced, noticed, fits, strict=True)
            if not relevant or cross_validate(fit, smaller_fit, workspace.bank) <= 0.0
        ]
        if not idle:
            break
        fit = workspace.fit(idle[-1])  # without the one that came last
    return replace(selection, best=fit)


def cross_validate(fit: Fit, smaller: Fit, bank: FilterBank) -> float:
    """By how much `fit` lowers the squared innovations on held-out blocks, compared to `smaller`.

    Both were fitted to all blocks. Their parameters without the blocks of a fold follow from that
    to first order.
    """
    fold = number_blocks(bank.runs) % FOLDS
    costs = [_sum_held_out(f, bank, fit.noise, fold) for f in (smaller, fit)]
    return costs[0] - costs[1]


def _sum_held_out(one: Fit, bank: FilterBank, noise: Noise, fold: Array) -> float:
    """Sum of the squared innovations of all folds, each with parameters fitted to the others."""
    rows = bank.whiten(one.linearised.rows, noise)
    parts = [gram(as_rows(rows[..., fold == k])) for k in np.unique(fold)]
    total = sum(parts)
    return sum(_cost_at(part, newton_step(total - part)) for part in parts)


def _cost_at(G: Array, x: Array) -> float:
    """Sum of squares after a step (k,), from the Gram matrix of errors and derivatives."""
    return float(G[0, 0] + 2.0 * G[1:, 0] @ x + x @ G[1:, 1:] @ x)
