"""Is an effect still sure once every stretch of time counts for what it tells by itself?

What pushes along an axis that nobody measures moves the vehicle there for as long as drag lets it,
and what a filter on board estimates errs for as long as it drifts: all readings of that time err
alike. The observer does not know, but blocks of time then differ by more than it foresees.
"""

from dataclasses import replace

import numpy as np

from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.observed_run import BLOCK, number_blocks
from rovsim.estimation.observer.sandwich import estimate_covariance

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
        rows = workspace.bank.whiten(fit.linearised.rows, fit.noise)
        as_blocks_see = replace(fit, covariance=estimate_covariance(rows, blocks))
        most = len(np.unique(blocks)) // BLOCKS_EACH  # numbers that so many blocks can judge
        for i, (term, own) in enumerate(zip(h.terms, h.columns, strict=True)):
            judged = term.vanishes and 0 < len(own) <= most
            if judged and as_blocks_see.distance(own) < workspace.penalty * term.choices:
                unsure.add(i)
    return sorted(unsure)
