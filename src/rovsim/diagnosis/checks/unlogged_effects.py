"""Is an effect needed beside what happened while lines of the command log were lost?

The model pushes late at each lost line, so it is late on the whole by the share of lost lines times
their period. A hundredth of lines at 10 Hz is a delay of -1 ms, which precise runs are sure of.
"""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.structure.lost_commands import LostCommands
from rovsim.diagnosis.structure.residual import split_by_run
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.least_squares import as_rows, gram, newton_step, solve


def drop_unlogged(selection: SearchResult) -> SearchResult:
    """Remove effects that are not worth their penalty if any push may have acted at lost lines."""
    workspace, fit = selection.workspace, selection.best
    while (k := _find_unlogged(fit, selection)) is not None:
        fit = workspace.fit(fit.hypothesis.without(k))
    return replace(selection, best=fit)


def _find_unlogged(fit: Fit, selection: SearchResult) -> int | None:
    """Number of the term that is worth the least; None where all are worth their penalty."""
    workspace = selection.workspace
    rows = _clear_lost(fit, workspace.bank)
    if rows is None:
        return None
    h, G = fit.hypothesis, gram(as_rows(rows))
    without_lost = replace(fit.linearised, hypothesis=h.at(h.x + newton_step(G)))
    covariance = solve(G[1:, 1:], np.eye(len(h.x)))
    as_logged = replace(fit, linearised=without_lost, covariance=covariance)
    worth = {
        i: as_logged.distance(columns) / (workspace.penalty * term.choices)
        for i, (term, columns) in enumerate(zip(h.terms, h.columns, strict=True))
        if term.vanishes and len(columns)
    }
    weakest = min(worth, key=lambda i: worth[i], default=None)
    return weakest if weakest is not None and worth[weakest] < 1.0 else None


def _clear_lost(fit: Fit, bank: FilterBank) -> Array | None:
    """Whitened errors and derivatives (1 + k, 6, n) without what acted while lines were lost.

    None where no line was lost. Axes that were not in every reading stay as they are, as their
    filters run at another rate.
    """
    lost = [LostCommands.of(run, fit.hypothesis.model) for run in bank.runs]
    if not any(len(gaps.times) for gaps in lost):
        return None
    rows = bank.whiten(fit.linearised.rows, fit.noise)
    parts = zip(split_by_run(rows, bank.runs), lost, bank.design_filters(fit.noise), strict=True)
    for of_run, gaps, designed in parts:
        for i, f in enumerate(designed.filters):
            if gaps.run.innovation_mask[:, i].all():
                of_run[:, i] = gaps.clear(of_run[:, i], i, f)  # a view of `rows`
    return rows
