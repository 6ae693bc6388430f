"""`comparison.json`: errors of models by run and horizon (docs/formats.md)."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.horizons import OPEN_LOOP
from rovsim.core.schema import Section
from rovsim.results.base import ByAxis, Result


class Metrics(Section):
    """Errors of one prediction, SI units; None where the model left the finite numbers."""

    acceleration_rmse: ByAxis
    velocity_mae: ByAxis
    velocity_rmse: ByAxis
    position_rmse_m: float | None
    attitude_rmse_rad: float | None

    def by_axis(self, quantity: str) -> ByAxis:
        """One of the quantities that have a value for each axis."""
        return getattr(self, quantity)


class RunErrors(Section):
    """Errors of one model on one run; `windows` by their length in s: `0.5`, `2`, `5`."""

    split: str
    control: str
    open_loop: Metrics
    windows: dict[str, Metrics]

    def at(self, horizon: str) -> Metrics | None:
        """The errors at one horizon (`open_loop`, or a window's length), if they were computed."""
        return self.open_loop if horizon == OPEN_LOOP else self.windows.get(horizon)


class ModelErrors(Section):
    """Errors of one model, by run."""

    runs: dict[str, RunErrors]


class Comparison(Result):
    """Errors by model and run."""

    noun: ClassVar[str] = "comparison"
    command: ClassVar[str] = "`rovsim compare`"

    schema_: Literal["rovsim.comparison/1"] = Field(default="rovsim.comparison/1", alias="schema")
    models: dict[str, ModelErrors]
