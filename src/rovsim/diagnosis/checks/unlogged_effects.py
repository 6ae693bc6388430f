"""Is an effect needed beside what other commands may have done than were logged?

Where lost lines cannot be put back (`lost_lines`), the model pushes late, so it is late on the
whole: by 1 ms where a log at 10 Hz lost a hundredth of its lines, which precise runs are sure of.
"""

from dataclasses import replace

from numpy import ndarray as Array

from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.structure.residual import split_by_run
from rovsim.diagnosis.structure.uncertain_commands import UncertainCommands
from rovsim.estimation.fit import Fit, refit_to_rows
from rovsim.estimation.observer.filter_bank import FilterBank


def drop_unlogged(selection: SearchResult) -> SearchResult:
    """Remove effects not worth their penalty beside any push where the log is uncertain."""
    workspace, fit = selection.workspace, selection.best
    while fit.hypothesis.terms and (k := _find_unlogged(fit, selection)) is not None:
        fit = workspace.fit(fit.hypothesis.without(k))
    return replace(selection, best=fit)


def _find_unlogged(fit: Fit, selection: SearchResult) -> int | None:
    """Number of the term that is worth the least; None where all are worth their penalty."""
    workspace = selection.workspace
    rows = _clear_uncertain(fit, workspace.bank)
    if rows is None:
        return None
    h, as_logged = fit.hypothesis, refit_to_rows(fit, rows)
    worth = {
        i: workspace.weigh_term(as_logged, i)
        for i, (term, columns) in enumerate(zip(h.terms, h.columns, strict=True))
        if term.vanishes and len(columns)
    }
    weakest = min(worth, key=lambda i: worth[i], default=None)
    return weakest if weakest is not None and worth[weakest] < 1.0 else None


def _clear_uncertain(fit: Fit, bank: FilterBank) -> Array | None:
    """Whitened errors and derivatives (1 + k, 6, n) without what acted where a log is uncertain.

    None where it is certain. Axes that were not in every reading stay as they are, as their filters
    run at another rate.
    """
    commands = [UncertainCommands.of(run, fit.hypothesis.model) for run in bank.runs]
    if not any(len(of_run.times) for of_run in commands):
        return None
    rows = bank.whiten(fit.linearised.rows, fit.noise)
    filters = [designed.filters for designed in bank.design_filters(fit.noise)]
    for part, of_run, f in zip(split_by_run(rows, bank.runs), commands, filters, strict=True):
        for i in range(len(f)):
            if of_run.run.innovation_mask[:, i].all():
                part[:, i] = of_run.clear(part[:, i], i, f[i])  # a view of `rows`
    return rows
