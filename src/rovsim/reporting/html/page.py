"""Put the numbers, sentences and figures of a study into one self-contained HTML page."""

from base64 import b64encode
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Mapping, Sequence

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from latex2mathml.converter import convert
from markupsafe import Markup

from rovsim.core.errors import BadInput
from rovsim.core.files import write_text
from rovsim.core.mappings import leaves
from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.figures import SECTIONS, kind
from rovsim.reporting.figures.inference_time import RATES
from rovsim.reporting.figures.marks import AXES, number, significant
from rovsim.reporting.html.published_errors import repeated, said
from rovsim.reporting.html.sentences import summary
from rovsim.reporting.html.verdict import verdict
from rovsim.reporting.tables import Table, errors_table, ladder_table, published_errors_table

# The JSON files of a study that the report reads.
CONTENTS = ("comparison", "ladder", "timing", "where", "diagnosis", "published_errors", "pitfalls")
# What the Compare section tabulates: horizon and quantity.
COMPARED = (
    ("2", "velocity_rmse"),
    ("2", "acceleration_rmse"),
    ("2", "velocity_mae"),
    ("open_loop", "velocity_rmse"),
)


@dataclass(frozen=True)
class Picture:
    """A drawn figure: registered name, PNG, and what it shows ("run 6dof-2, 2 s windows")."""

    name: str
    png: bytes
    about: str = ""

    @staticmethod
    def read(path: Path, name: str, about: str = "") -> "Picture":
        """Read a PNG that `rovsim.reporting.figures.style.save` wrote.

        Raises:
            BadInput: the file cannot be read or is no PNG.
        """
        try:
            png = path.read_bytes()
        except OSError as error:
            found = f"cannot be read ({error.strerror})"
        else:
            if png.startswith(b"\x89PNG"):
                return Picture(name, png, about)
            found = "is not a PNG picture"
        remedy = "Draw the figure again."
        raise BadInput(found, where=path, expected="a figure of the study", remedy=remedy)

    @property
    def source(self) -> str:
        """The picture as a data address."""
        return f"data:image/png;base64,{b64encode(self.png).decode()}"

    @property
    def caption(self) -> str:
        """What is seen, and of which run."""
        text = kind(self.name).caption
        return f"{self.about[0].upper()}{self.about[1:]}. {text}" if self.about else text


@dataclass(frozen=True)
class ReportInputs:
    """Everything the report shows; a section without content is left out.

    `comparison`, `ladder`, `timing`, `where`, `diagnosis`, `published_errors`, `pitfalls`: contents
    of the JSON files of those names. `quality`: the quality reports by run. `pictures`: in order
    of appearance. `provenance`: nested plain values (settings, code digest, versions).
    `catalogue`: what the effects of the diagnosis are.
    """

    campaign: str
    comparison: Mapping[str, Any] = field(default_factory=dict)
    ladder: Mapping[str, Any] = field(default_factory=dict)
    timing: Mapping[str, Any] = field(default_factory=dict)
    quality: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    pictures: Sequence[Picture] = ()
    provenance: Mapping[str, Any] = field(default_factory=dict)
    where: Mapping[str, Any] = field(default_factory=dict)
    diagnosis: Mapping[str, Any] = field(default_factory=dict)
    published_errors: Mapping[str, Any] = field(default_factory=dict)
    pitfalls: Mapping[str, Any] = field(default_factory=dict)
    catalogue: Mapping[str, type[Effect]] = field(default_factory=dict)


def render(inputs: ReportInputs) -> str:
    """Return the report as HTML: no script, nothing from the network, every name escaped."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["significant"] = lambda value: significant(number(value))
    environment.filters["mathml"] = lambda latex: Markup(convert(latex))
    environment.filters["percent"] = lambda share: f"{100 * share:.1f}\u202f%"
    return environment.get_template("report.html").render(
        campaign=inputs.campaign,
        verdict=verdict(inputs.diagnosis, inputs.catalogue) if inputs.diagnosis else None,
        summary=_summary(inputs),
        where=inputs.where.get("models", {}),
        errors=_errors(inputs.comparison) if inputs.comparison else [],
        ladder=ladder_table(inputs.ladder),
        published_errors=published_errors_table(inputs.published_errors),
        published=said(inputs.published_errors),
        pitfalls=repeated(inputs.pitfalls),
        timing=inputs.timing.get("inference", {}),
        rates=RATES,
        quality=inputs.quality,
        axes=AXES,
        pictures=_by_section(inputs.pictures),
        provenance=rows_of(inputs.provenance),
    )


def _summary(inputs: ReportInputs) -> list[str]:
    if not inputs.comparison:
        return []
    return summary(inputs.comparison, inputs.ladder, inputs.timing, inputs.quality)


def write(path: Path, inputs: ReportInputs) -> None:
    """Write the report, whole or not at all."""
    write_text(path, render(inputs))


def rows_of(content: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Nested values as rows of a dotted name and a text."""
    return [(name, _text(value)) for name, value in leaves(content).items()]


def _text(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(str(v) for v in value) or "none"
    return "none" if value is None or value == {} else str(value)


def _errors(comparison: Mapping[str, Any]) -> list[Table]:
    return [errors_table(comparison, horizon, "test", quantity) for horizon, quantity in COMPARED]


def _by_section(pictures: Sequence[Picture]) -> dict[str, list[Picture]]:
    return {s: [p for p in pictures if kind(p.name).section == s] for s in SECTIONS}
