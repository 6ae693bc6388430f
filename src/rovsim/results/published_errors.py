"""`published_errors.json`: errors on held-out runs beside the smallest that others published."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import ByAxis, Result


class Source(Section):
    """Whose error it is."""

    model: str
    variant: str


class PublishedCell(Section):
    """One run, axis and metric: the mark to beat, whose it is, every model's error and ratio."""

    run: str
    axis: str
    metric: str
    demanded: bool
    mark: float
    best: Source
    errors: dict[str, float | None]
    ratios: dict[str, float | None]


class Standing(Section):
    """Cells below the mark, and the geometric mean of error / mark."""

    cells: int
    below: int
    share_below: float | None
    geometric_mean: float | None


class MissedCell(Section):
    """A cell in which a model is not below the mark; None: it has no value there."""

    run: str
    axis: str
    metric: str
    ratio: float | None


class ModelStanding(Standing):
    """How one model stands in the counted metrics, and by metric and axis."""

    by_metric: dict[str, Standing]
    by_axis: ByAxis
    not_below: tuple[MissedCell, ...]


class PublishedErrors(Result):
    """Models, ours first, and the cells they are judged by."""

    noun: ClassVar[str] = "comparison with published errors"
    command: ClassVar[str] = "the study of the folds"

    schema_: Literal["rovsim.published_errors/1"] = Field(
        default="rovsim.published_errors/1", alias="schema"
    )
    runs: tuple[str, ...]
    without_published: tuple[str, ...]
    models: dict[str, ModelStanding]
    cells: tuple[PublishedCell, ...]
