"""`bands.json`: how often what was measured lies within the bands of a model's predictions."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import ByAxis, Result


class Coverage(Section):
    """Of `points` velocities on each axis: the share `inside` the band, and its mean `width`.

    `at_end` the share of the last ones of the `windows`, where a band is widest; m/s, rad/s.
    """

    points: int
    windows: int
    inside: ByAxis
    at_end: ByAxis
    width: ByAxis


class RunBands(Section):
    """Of one run; `windows` by their length in s."""

    split: str
    windows: dict[str, Coverage]


class ModelBands(Section):
    """Of one model, by run."""

    runs: dict[str, RunBands]


class Bands(Result):
    """By model and run; `level` is the share that should lie inside."""

    noun: ClassVar[str] = "table of bands"
    command: ClassVar[str] = "`rovsim compare`"

    schema_: Literal["rovsim.bands/1"] = Field(default="rovsim.bands/1", alias="schema")
    level: float
    models: dict[str, ModelBands]
