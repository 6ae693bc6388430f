"""`growth.json`: how the velocity error grows with the time since the anchor."""

from typing import ClassVar

from rovsim.core.schema import Section
from rovsim.results.base import Result


class Curve(Section):
    """Velocity RMSE (n values an axis, m/s, rad/s) at `horizon_s` (n values) since the anchor."""

    horizon_s: tuple[float, ...]
    velocity_rmse: dict[str, tuple[float | None, ...]]


class Growth(Result):
    """One curve a model."""

    noun: ClassVar[str] = "growth of the error"
    command: ClassVar[str] = "the study"

    models: dict[str, Curve]
