"""Is an effect still sure once every stretch of time counts for what it tells by itself?

What pushes along an axis that nobody measures moves the vehicle there for as long as drag lets it,
and what a filter on board estimates errs for as long as it drifts: all readings of that time err
alike. The observer does not know, but blocks of time then differ by more than it foresees.
"""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.least_squares import as_rows, inner_products, solve
from rovsim.diagnosis.observer.observed_run import BLOCK, number_blocks
from rovsim.diagnosis.selection.gauss_newton import Fit
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace

LASTING = (BLOCK, 3.0 * BLOCK)  # s: what drags on, and what drifts
BLOCKS_EACH = 3  # of every number of an effect: fewer do not tell how much blocks differ


def drop_unsure(selection: SearchResult) -> SearchResult:
    """Without effects that are not worth their penalty by how much blocks of time differ.

    Asked only where the vehicle moves along axes that nobody measures.
    """
    workspace, fit = selection.workspace, selection.best
    if not any((run.free_axes & ~run.axes).any() for run in workspace.bank.runs):
        return selection
    while unsure := list_unsure(fit, workspace):
        fit = workspace.fit(fit.hypothesis.without(unsure[-1]))  # the one that came last
    return replace(selection, best=fit)


def list_unsure(fit: Fit, workspace: SearchWorkspace) -> list[int]:
    """Terms whose distance from their absence is less than their penalty, as blocks see it."""
    h, unsure = fit.hypothesis, set()
    for seconds in LASTING:
        blocks = number_blocks(workspace.bank.runs, seconds)
        as_blocks_see = replace(fit, covariance=estimate_spread(fit, workspace.bank, blocks))
        most = len(np.unique(blocks)) // BLOCKS_EACH  # numbers that so many blocks can judge
        for i, (term, own) in enumerate(zip(h.terms, h.columns, strict=True)):
            judged = term.vanishes and 0 < len(own) <= most
            if judged and as_blocks_see.distance(own) < workspace.penalty * term.choices:
                unsure.add(i)
    return sorted(unsure)


def estimate_spread(fit: Fit, bank: FilterBank, blocks: Array) -> Array:
    """Covariance (k, k) of the scaled parameters, by how much `blocks` (n,) differ.

    That of Liang & Zeger (1986), which does not take readings of one block for independent.
    """
    rows = bank.whiten(fit.seen.rows, fit.noise)
    each = rows[1:] * rows[:1]
    scores = np.array([each[..., blocks == b].sum(axis=(1, 2)) for b in np.unique(blocks)])
    scores = scores - scores.mean(axis=0)
    inverse = solve(inner_products(as_rows(rows[1:])), np.eye(len(rows) - 1))
    return np.asarray(inverse @ (scores.T @ scores) @ inverse * len(scores) / (len(scores) - 1))
