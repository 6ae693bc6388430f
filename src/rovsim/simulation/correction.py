"""Readings that correct models while they run along a recording."""

from dataclasses import dataclass
from typing import Sequence

from numpy import ndarray as Array


@dataclass(frozen=True, eq=False)
class Correction:
    """Readings, and the filters that correct models by them.

    Attributes:
        readings: of each model (k, 13): pose, and mean velocity since the reading before.
        seen: (k, 6) 1 for the axes that each reading shows, else 0.
        known: (5,) which parts of a pose were measured, see `pose_error` of the engine.
        time: (s+1,) at which the steps begin and end, s.
        ends: (k,) edges at which the readings hold, as indices into `time`.
        gains: corrections (3, 6) of pose, velocity and disturbance per unit of innovation.
        decay: share (s, 6) of the disturbance that remains after each step.
        by_velocity: whether velocities are read. Poses are then taken as measured.
    """

    readings: Sequence[Array]
    seen: Array
    known: Array
    time: Array
    ends: Array
    gains: Array
    decay: Array
    by_velocity: bool
