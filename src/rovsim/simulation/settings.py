"""How runs are replayed."""

from typing import Any, Mapping

from pydantic import PositiveFloat

from rovsim.core.schema import Section, checked
from rovsim.dynamics.actuation import Between
from rovsim.measurement.signals.chain import SignalSettings


class ReplaySettings(Section):
    """`step` s is the longest integration step; `commands` between two logged lines."""

    step: PositiveFloat = 0.01  # RK4's error is below 1e-6 m/s here (tests/laws/test_replay.py)
    commands: Between = "held"  # what an autopilot does with a set-point
    horizons: tuple[PositiveFloat, ...] = (0.5, 2.0, 5.0)  # s, contract section 3


def rule_settings(given: Mapping[str, Any]) -> tuple[SignalSettings, ReplaySettings]:
    """How motions were made and are replayed, from the parameters of a rule.

    Raises:
        BadInput: one of them does not fit.
    """
    signals = checked(SignalSettings, given["signals"], "conf")
    return signals, checked(ReplaySettings, given["replay"], "conf")
