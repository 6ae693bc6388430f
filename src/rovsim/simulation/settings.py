"""How runs are replayed."""

from pydantic import PositiveFloat

from rovsim.core.schema import Section
from rovsim.dynamics.actuation import Between


class ReplaySettings(Section):
    """`step` s is the longest integration step; `commands` between two logged lines."""

    step: PositiveFloat = 0.01  # RK4's error is below 1e-6 m/s here (tests/laws/test_replay.py)
    commands: Between = "held"  # what an autopilot does with a set-point
    horizons: tuple[PositiveFloat, ...] = (0.5, 2.0, 5.0)  # s, contract section 3
