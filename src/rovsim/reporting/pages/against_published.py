"""Write `published_errors.json` as Markdown tables."""

from rovsim.evaluation.held_out.published_errors import (
    JUDGED_METRICS,
    METRICS,
    PUBLISHED_PREFIX,
    stand,
)
from rovsim.reporting.pages.marked import table
from rovsim.reporting.tables import QUANTITIES
from rovsim.reporting.wording import number_or_dash, significant
from rovsim.reporting.words.published_errors import tell_standings
from rovsim.results.published_errors import PublishedErrors

# the authors' simulator without a residual: the baseline
SIMULATOR = f"{PUBLISHED_PREFIX}zero_shot"


def write_markdown(published_errors: PublishedErrors) -> list[str]:
    """Return the paragraphs of Markdown on `published_errors.json`."""
    lacking = published_errors.without_published
    parts = [*tell_standings(published_errors), _tabulate_standings(published_errors)]
    parts += _on_one_baseline(published_errors)
    parts += [part for metric in METRICS for part in _cells(published_errors, metric)]
    return parts + ([f"Nothing is published for {', '.join(lacking)}."] if lacking else [])


def _tabulate_standings(published_errors: PublishedErrors) -> str:
    head = [
        "model",
        "below the mark",
        "geometric mean of the ratios",
        *(QUANTITIES[metric][0] for metric in METRICS),
    ]
    rows = [
        [
            name,
            f"{standing.below} of {standing.cells}",
            number_or_dash(standing.geometric_mean),
            *(number_or_dash(standing.by_metric[m].geometric_mean) for m in METRICS),
        ]
        for name, standing in published_errors.models.items()
    ]
    return table(head, rows)


def _on_one_baseline(published_errors: PublishedErrors) -> list[str]:
    """Return a table of all models' errors divided by those of the authors' simulator.

    Empty where that simulator is not among the published models.
    """
    if SIMULATOR not in published_errors.models:
        return []
    rows = [
        [
            name,
            *(
                number_or_dash(_against_simulator(published_errors, name, metric))
                for metric in METRICS
            ),
        ]
        for name in published_errors.models
    ]
    return [
        "### On one baseline",
        "Theirs and ours divided by the smallest published `zero_shot` error of each cell, "
        "geometric means. Others' residuals are at the better of their variants, cell by cell, and "
        "learned from other runs than ours.",
        table(["model", *(QUANTITIES[metric][0] for metric in METRICS)], rows),
    ]


def _against_simulator(published_errors: PublishedErrors, name: str, metric: str) -> float | None:
    cells = [c for c in published_errors.cells if c.metric == metric and name in c.ratios]
    errors = [(c.errors[name], c.errors[SIMULATOR]) for c in cells]
    return stand([None if e is None or not base else e / base for e, base in errors]).geometric_mean


def _cells(published_errors: PublishedErrors, metric: str) -> list[str]:
    """Return heading and table of one metric: the smallest published errors, and our ratios."""
    heading, units = QUANTITIES[metric]
    own_models = [name for name in published_errors.models if not name.startswith(PUBLISHED_PREFIX)]
    rows = [
        [
            cell.run,
            cell.axis if cell.demanded else f"({cell.axis})",
            significant(cell.mark),
            f"{cell.best.model}, {cell.best.variant}",
            *(number_or_dash(cell.ratios.get(name)) for name in own_models),
        ]
        for cell in published_errors.cells
        if cell.metric == metric
    ]
    extra = "" if metric in JUDGED_METRICS else ", not counted above"
    units_text = " and ".join(dict.fromkeys(units))
    return [
        f"### {heading[0].upper()}{heading[1:]}",
        f"The mark in {units_text}, whose it is, and our errors divided by it{extra}.",
        table(["run", "axis", "mark", "smallest published", *own_models], rows),
    ]
