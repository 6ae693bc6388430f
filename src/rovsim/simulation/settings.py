"""How runs are replayed."""

from pydantic import PositiveFloat, field_validator

from rovsim.core.schema import Section
from rovsim.dynamics.actuation import Between
from rovsim.results.comparison import WINDOW


class ReplaySettings(Section):
    """`step` s is the longest integration step; `commands` between two logged lines."""

    step: PositiveFloat = 0.01  # RK4's error is below 1e-6 m/s here (tests/laws/test_replay.py)
    commands: Between = "held"  # what an autopilot does with a set-point
    horizons: tuple[PositiveFloat, ...] = (0.5, WINDOW, 5.0)  # s (docs/signals.md)

    def only(self, *horizons: float) -> "ReplaySettings":
        """The same with these windows, perhaps none."""
        return self.model_copy(update={"horizons": horizons})

    @field_validator("horizons")
    @classmethod
    def _has_that_of_the_ladder(cls, horizons: tuple[float, ...]) -> tuple[float, ...]:
        if WINDOW not in horizons or len(set(horizons)) < len(horizons):
            raise ValueError(f"{WINDOW:g} s and others, each once")
        return horizons
