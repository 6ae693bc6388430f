"""Pulses of a radio control, in us, and the commands in [-1, 1] that they mean."""

import numpy as np
from numpy import ndarray as Array

# PWM = 1500 us + 400 us c, as the vehicle files' comments say.
REST_PULSE_US, PULSE_SPAN_US = 1500.0, 400.0
NO_PULSES = (0.0, 65535.0)  # values with which MAVLink says that an output or input has no pulses
# ArduSub, "RC input and output": channels of the pilot; throttle is up.
PILOT_CHANNELS = {"RC5": "surge", "RC6": "sway", "-RC3": "heave", "RC2": "roll", "RC1": "pitch",
                  "RC4": "yaw"}  # fmt: skip


def absent(pulses: Array) -> Array:
    """Mask, of the same shape, of the values that mean "no pulse"."""
    return np.isin(pulses, NO_PULSES)


def of_inputs(pulses: Array) -> Array:
    """Pulses of inputs, us, with NaN (unknown) where there is no pulse."""
    return np.where(absent(pulses), np.nan, pulses)


def of_outputs(pulses: Array) -> tuple[Array, tuple[str, ...]]:
    """Pulses of outputs, us, with that of a thruster at rest where there is none.

    Returns:
        The pulses, and a sentence if any was replaced.
    """
    missing = absent(pulses)
    if not missing.any():
        return pulses, ()
    warning = f"{int(missing.sum())} outputs without a pulse stand for no command."
    return np.where(missing, REST_PULSE_US, pulses), (warning,)


def to_commands(pulses: Array) -> Array:
    """Convert pulses in us to commands; 1100 to 1900 us become -1 to 1."""
    return (pulses - REST_PULSE_US) / PULSE_SPAN_US


def to_pulses(command: Array) -> Array:
    """Convert commands in [-1, 1] to pulses in whole us."""
    return np.round(REST_PULSE_US + PULSE_SPAN_US * command)


def in_whole_pulses(command: Array) -> Array:
    """Round commands to the nearest ones that pulses in whole us can express."""
    return np.round(PULSE_SPAN_US * command) / PULSE_SPAN_US
