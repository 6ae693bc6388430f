"""Write the numbers, sentences and figures of results into one self-contained HTML page."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Mapping, Sequence

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from rovsim.core.axes import AXES
from rovsim.core.files import write_text
from rovsim.core.horizons import OPEN_LOOP, STANDARD_HORIZON
from rovsim.core.making import describe_making
from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.figures import SECTIONS, find_figure
from rovsim.reporting.formula import mathml
from rovsim.reporting.html.picture import Picture
from rovsim.reporting.report_data import ReportData
from rovsim.reporting.tables import (
    Table,
    tabulate_errors,
    tabulate_ladder,
    tabulate_published_errors,
)
from rovsim.reporting.wording import explain_model, listed, several, short, significant, title
from rovsim.reporting.words.published_errors import tell_pitfalls, tell_standings
from rovsim.reporting.words.sentences import doubt_sentences, summarize
from rovsim.reporting.words.verdict import explain
from rovsim.results.base import or_nan
from rovsim.results.comparison import Comparison
from rovsim.results.ladder import Ladder
from rovsim.results.published_errors import PublishedErrors
from rovsim.results.timing import CONTROL_RATES_HZ

# What the Compare section tabulates: horizon and quantity.
COMPARED_METRICS = (
    (STANDARD_HORIZON, "velocity_rmse"),
    (STANDARD_HORIZON, "acceleration_rmse"),
    (STANDARD_HORIZON, "velocity_mae"),
    (OPEN_LOOP, "velocity_rmse"),
)


@dataclass(frozen=True, eq=False)
class Report:
    """Everything that the report shows; a section without content is left out.

    Attributes:
        campaign: its name.
        data: the results.
        pictures: in order of appearance.
        provenance: nested plain values: settings, code digest, versions.
        catalogue: effects of the diagnosis, by id.
        made: when and where the report was made.
    """

    campaign: str
    data: ReportData
    pictures: Sequence[Picture] = ()
    provenance: Mapping[str, object] = field(default_factory=dict)
    catalogue: Mapping[str, type[Effect]] = field(default_factory=dict)
    made: str = ""


def render(report: Report) -> str:
    """Return the report as HTML: no script, nothing from the network, every name escaped."""
    data = report.data
    if data.ladder is None and data.steps:
        data = replace(data, ladder=Ladder(steps=data.steps))
    return (
        _environment()
        .get_template("report.html")
        .render(
            campaign=report.campaign,
            folder=_folder(report.provenance),
            subtitle=_subtitle(data),
            made=report.made,
            verdict=explain(data.diagnosis, report.catalogue) if data.diagnosis else None,
            doubts=doubt_sentences(data.quality),
            summary=summarize(data),
            where=data.where.models if data.where else {},
            errors=_tabulate_errors(data.comparison) if data.comparison else [],
            ladder=tabulate_ladder(data.ladder) if data.ladder else None,
            step_by_step=report.data.ladder is not None,
            published=_tabulate_published(data.published_errors) if data.published_errors else None,
            pitfalls=tell_pitfalls(data.pitfalls) if data.pitfalls else [],
            models=_explained(data),
            timing=data.timing.inference if data.timing else {},
            rates=CONTROL_RATES_HZ,
            quality=data.quality,
            axes=AXES,
            undrawn=_tell_undrawn(data),
            pictures=_by_section(report.pictures),
            provenance=list_rows(report.provenance),
        )
    )


def _subtitle(data: ReportData) -> str:
    """Return the subtitle of a report of `compare`, of `diagnose`, or of a study."""
    if data.diagnosis is None:
        return "How far the models are from the measurement, and where"
    if data.comparison is None:
        return "Which physics the simulator lacks, and how sure that is"
    return "How far the simulator is from the measurement, and what brings it closer"


def _folder(provenance: Mapping[str, object]) -> str:
    """Return the absolute folder of the campaign, by which a later report recognizes it."""
    settings = provenance.get("settings")
    campaign = settings.get("campaign") if isinstance(settings, Mapping) else None
    return str(Path(campaign).expanduser().absolute()) if isinstance(campaign, str) else ""


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["significant"] = lambda value: significant(or_nan(value))
    environment.filters["mathml"] = lambda latex: Markup(mathml(latex))
    environment.filters["several"] = several
    environment.filters["title"] = title
    environment.filters["milli"] = lambda value: None if value is None else 1e3 * value
    environment.filters["percent"] = lambda share: f"{100 * share:.1f}\u202f%"
    return environment


def write(path: Path, report: Report) -> None:
    """Write the report, whole or not at all, with the time and place of making it."""
    write_text(path, render(replace(report, made=describe_making())))


def list_rows(content: Mapping[str, object], above: str = "") -> list[tuple[str, str]]:
    """Return nested values as rows: the dotted name of a section, and all its values as text."""
    rows, values = [], {}
    for name, value in content.items():
        place = f"{above}.{name}" if above else name
        if isinstance(value, Mapping) and value:
            rows += list_rows(value, place)
        elif above:
            values[name] = _text(value)
        else:
            rows.append((name, _text(value)))
    summary = "; ".join(f"{name} {text}" for name, text in values.items())
    return [(above, summary), *rows] if values else rows


def _text(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(str(v) for v in value) or "none"
    return "none" if value is None or value == {} else str(value)


def _tabulate_errors(comparison: Comparison) -> list[Table]:
    return [tabulate_errors(comparison, h, "test", quantity) for h, quantity in COMPARED_METRICS]


def _explained(data: ReportData) -> dict[str, str]:
    """Return explanations of the study's models, by their titles in the report."""
    compared = list(data.comparison.models) if data.comparison else []
    steps = [step.model for step in data.ladder.steps] if data.ladder else []
    meanings = {title(name): explain_model(name) for name in (*steps, *compared)}
    return {name: text for name, text in meanings.items() if text}


def _tabulate_published(published_errors: PublishedErrors) -> tuple[Table, list[str]]:
    return tabulate_published_errors(published_errors), tell_standings(published_errors)


def _tell_undrawn(data: ReportData) -> str:
    """Say which runs have figures of their own; empty where all have or none has."""
    if len(data.drawn) in (0, len(data.motions)):
        return ""
    return (
        f"Of {len(data.motions)} runs, {listed(map(short, data.drawn))} have figures of their own: "
        f"of many, those on which {title(list(data.replays)[-1])} errs most. The workbench shows "
        "each."
    )


def _by_section(pictures: Sequence[Picture]) -> dict[str, dict[str, list[Picture]]]:
    """Sort pictures by section and run; those of all runs (run "") come first."""
    sections: dict[str, dict[str, list[Picture]]] = {section: {"": []} for section in SECTIONS}
    for picture in pictures:
        sections[find_figure(picture.name).section].setdefault(picture.run, []).append(picture)
    return sections
