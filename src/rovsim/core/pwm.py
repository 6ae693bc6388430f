"""Pulses of a radio control, in us, and the commands in [-1, 1] that they mean."""

import numpy as np
from numpy import ndarray as Array

# PWM = 1500 us + 400 us c, as the vehicle files' comments say.
CENTER, SPAN = 1500.0, 400.0
NONE = (0.0, 65535.0)  # what MAVLink tells of an output or input without pulses
# ArduSub, "RC input and output": channels of the pilot; throttle is up.
PILOT = {"RC5": "surge", "RC6": "sway", "-RC3": "heave", "RC2": "roll", "RC1": "pitch",
         "RC4": "yaw"}  # fmt: skip


def absent(pulses: Array) -> Array:
    """Which of them are none."""
    return np.isin(pulses, NONE)


def of_inputs(pulses: Array) -> Array:
    """Pulses of inputs, of which one without a pulse is unknown (NaN)."""
    return np.where(absent(pulses), np.nan, pulses)


def of_outputs(pulses: Array) -> tuple[Array, tuple[str, ...]]:
    """Pulses of outputs where none stands for a thruster at rest, and a sentence if any does."""
    none = absent(pulses)
    if not none.any():
        return pulses, ()
    said = f"{int(none.sum())} outputs without a pulse stand for no command."
    return np.where(none, CENTER, pulses), (said,)


def to_commands(pulses: Array) -> Array:
    """Commands of pulses."""
    return (pulses - CENTER) / SPAN


def to_pulses(command: Array) -> Array:
    """Pulses of commands, in whole us."""
    return np.round(CENTER + SPAN * command)


def in_whole_pulses(command: Array) -> Array:
    """Commands that pulses in whole us mean, nearest to these."""
    return np.round(SPAN * command) / SPAN
