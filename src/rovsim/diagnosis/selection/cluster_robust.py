"""Is an effect still sure if blocks of time, not readings, are what counts as independent?

A push along an axis that nobody measures moves the vehicle until drag has stopped it, and an
estimate of a filter on board is wrong for as long as it drifts. All readings of that time then have
similar errors, which the noise of the observer does not describe. But blocks of time then differ
by more than this noise predicts.
"""

from dataclasses import replace

import numpy as np

from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.observed_run import BLOCK_SECONDS, number_blocks
from rovsim.estimation.observer.sandwich import estimate_covariance

CLUSTER_SECONDS = (BLOCK_SECONDS, 3.0 * BLOCK_SECONDS)  # how long such pushes and drifts last
MIN_BLOCKS_PER_PARAMETER = 3  # fewer blocks do not tell how much blocks differ


def drop_unsure(selection: SearchResult) -> SearchResult:
    """Remove effects that are not worth their penalty if blocks of time are independent.

    This is only done where the vehicle can move along axes that nobody measured.
    """
    workspace, fit = selection.workspace, selection.best
    if not any((run.free_axes & ~run.axes).any() for run in workspace.bank.runs):
        return selection
    while unsure := list_unsure(fit, workspace):
        fit = workspace.fit(fit.hypothesis.without(unsure[-1]))  # the one that came last
    return replace(selection, best=fit)


def list_unsure(fit: Fit, workspace: SearchWorkspace) -> list[int]:
    """Numbers of the terms that are not worth their penalty with the covariance between blocks."""
    h, unsure = fit.hypothesis, set()
    for seconds in CLUSTER_SECONDS:
        blocks = number_blocks(workspace.bank.runs, seconds)
        rows = workspace.bank.whiten(fit.linearised.rows, fit.noise)
        as_blocks_see = replace(fit, covariance=estimate_covariance(rows, blocks))
        # numbers that so many blocks can judge
        limit = len(np.unique(blocks)) // MIN_BLOCKS_PER_PARAMETER
        for i, (term, columns) in enumerate(zip(h.terms, h.columns, strict=True)):
            few_enough = term.vanishes and 0 < len(columns) <= limit
            if few_enough and workspace.weigh_term(as_blocks_see, i) < 1.0:
                unsure.add(i)
    return sorted(unsure)
