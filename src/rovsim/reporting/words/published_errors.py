"""Say what `published_errors.json` and `pitfalls.json` show, for the report and docs/thesis.md."""

from typing import Mapping

from rovsim.core.model_names import EFFECTS
from rovsim.reporting.tables import QUANTITIES
from rovsim.reporting.wording import number_or_dash, title
from rovsim.results.pitfalls import PITFALLS, Cost, Pitfalls
from rovsim.results.published_errors import ModelStanding, PublishedErrors


def tell_standings(published_errors: PublishedErrors) -> list[str]:
    """Say for each residual on top of effects in how many cells it is below the published error."""
    models = published_errors.models
    return [_sentence(n, standing) for n, standing in models.items() if n.startswith(f"{EFFECTS}+")]


def _sentence(name: str, standing: ModelStanding) -> str:
    missed = ", ".join(
        f"{c.run} {c.axis} {QUANTITIES[c.metric][0]} ({number_or_dash(c.ratio)})"
        for c in standing.not_below
    )
    return (
        f"{title(name)}: {standing.below} of {standing.cells} cells below the mark, geometric "
        f"mean of the ratios {number_or_dash(standing.geometric_mean)}. "
        + (f"Not below: {missed}." if missed else "")
    ).strip()


def tell_pitfalls(pitfalls: Pitfalls) -> list[str]:
    """Say for each mistake what was done, and what it cost on each run."""
    return [
        f"{name[0].upper()}{name[1:]}: {mistake}. {measure[0].upper()}{measure[1:]}: {costs}."
        for name, (mistake, measure) in PITFALLS.items()
        if (costs := _tell_costs(pitfalls.runs, name))
    ]


def _tell_costs(runs: Mapping[str, Mapping[str, Cost]], name: str) -> str:
    return ", ".join(
        f"{number_or_dash(costs[name].right)} becomes {number_or_dash(costs[name].wrong)} ({run})"
        for run, costs in runs.items()
        if name in costs
    )
