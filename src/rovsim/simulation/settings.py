"""How measurements are cleaned, and how runs are replayed."""

from typing import Annotated, Self

from pydantic import Field, PositiveFloat, field_validator

from rovsim.core.horizons import STANDARD_WINDOW
from rovsim.core.run import Between
from rovsim.core.schema import Section
from rovsim.measurement.signals.chain import SignalSettings


class ReplaySettings(Section):
    """Longest integration step, how commands go on between two logged lines, and the horizons."""

    # RK4's error is below 1e-6 m/s at 0.01 s (tests/laws/test_replay.py); above 0.14 s it leaves a
    # thruster whose time constant is 0.05 s unstable (2.79 time constants)
    step: Annotated[float, Field(gt=0.0, le=0.1)] = 0.01
    commands: Between = "held"  # what an autopilot does with a set-point
    horizons: tuple[PositiveFloat, ...] = (0.5, STANDARD_WINDOW, 5.0)  # s (docs/signals.md)

    @property
    def longest(self) -> float:
        """Longest horizon, s."""
        return max(self.horizons)

    def only(self, *horizons: float) -> Self:
        """Copy the settings with these horizons in s, perhaps none, in place of their own."""
        return self.model_copy(update={"horizons": horizons})

    @field_validator("horizons")
    @classmethod
    def _has_that_of_the_ladder(cls, horizons: tuple[float, ...]) -> tuple[float, ...]:
        if STANDARD_WINDOW not in horizons or len(set(horizons)) < len(horizons):
            raise ValueError(f"{STANDARD_WINDOW:g} s and others, each once")
        return horizons


class SimulationSettings(Section):
    """How measurements are cleaned, and how models are replayed beside them."""

    signals: SignalSettings = SignalSettings()
    replay: ReplaySettings = ReplaySettings()

    def only(self, *horizons: float) -> Self:
        """Copy the settings with these horizons in s, perhaps none, in place of their own."""
        return self.model_copy(update={"replay": self.replay.only(*horizons)})
