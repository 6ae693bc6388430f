"""How runs are replayed."""

from pydantic import PositiveFloat, field_validator

from rovsim.core.schema import Section
from rovsim.dynamics.actuation import Between

LADDER = 2.0  # s, the windows that ladder, figures and summaries are of (contract, section 3)


class ReplaySettings(Section):
    """`step` s is the longest integration step; `commands` between two logged lines."""

    step: PositiveFloat = 0.01  # RK4's error is below 1e-6 m/s here (tests/laws/test_replay.py)
    commands: Between = "held"  # what an autopilot does with a set-point
    horizons: tuple[PositiveFloat, ...] = (0.5, LADDER, 5.0)  # s, contract section 3

    def only(self, *horizons: float) -> "ReplaySettings":
        """The same with these windows, perhaps none."""
        return self.model_copy(update={"horizons": horizons})

    @field_validator("horizons")
    @classmethod
    def _has_that_of_the_ladder(cls, horizons: tuple[float, ...]) -> tuple[float, ...]:
        if LADDER not in horizons or len(set(horizons)) < len(horizons):
            raise ValueError(f"{LADDER:g} s and others, each once")
        return horizons
