"""Take pulses of a vehicle's outputs, or of a pilot's radio, for commands."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.pwm import PILOT_CHANNELS, absent
from rovsim.measurement.recording.candidates import CommandCandidate


def from_outputs(
    format: str, time: Array, pulses: Array, reason: str, topic: str | None = None
) -> CommandCandidate:
    """Take the outputs that carry pulses for commands of thrusters: SERVO1, SERVO2, ….

    Args:
        format: of the file.
        time: (m,) s.
        pulses: (m, c) us, those of all outputs from number 1.
        reason: how they are known, for a person to read.
        topic: of a bag.
    """
    used = np.flatnonzero(_carry_pulses(pulses))
    columns = tuple(f"SERVO{k + 1}" for k in used)
    return CommandCandidate(format, columns, time, pulses[:, used], "pwm", reason, topic)


def from_radio(
    format: str, time: Array, pulses: Array, reason: str, topic: str | None = None
) -> CommandCandidate:
    """Take the channels that carry pulses for demands of a pilot, by ArduSub's order of channels.

    Args:
        format: of the file.
        time: (m,) s.
        pulses: (m, c) us, those of all channels from number 1.
        reason: how they are known, for a person to read.
        topic: of a bag.
    """
    carrying = set(np.flatnonzero(_carry_pulses(pulses)))
    places = {c: k for c in PILOT_CHANNELS if (k := int(c.lstrip("-RC")) - 1) in carrying}
    axes = tuple(PILOT_CHANNELS[c] for c in places)
    value = pulses[:, list(places.values())]
    return CommandCandidate(format, tuple(places), time, value, "demand", reason, topic, axes)


def _carry_pulses(pulses: Array) -> Array:
    """Mark the channels (c,) that ever carried a pulse."""
    return (~absent(pulses) & np.isfinite(pulses)).any(axis=0)
