"""Readings that correct models while they run along a recording."""

from dataclasses import dataclass
from typing import Sequence

from numpy import ndarray as Array


@dataclass(frozen=True, eq=False)
class Correction:
    """Readings, and the filters that correct models by them.

    Attributes:
        readings: k readings (k, 13) for each model: pose in NED, and the mean body velocity since
            the previous reading.
        seen: (k, 6) 1 for the axes that each reading measures, else 0.
        known: (5,) which parts of a pose were measured, see `pose_error` of the engine.
        time: (s+1,) at which the steps begin and end, s.
        ends: (k,) the time of each reading, as an index into `time`.
        gains: filter gains (3, 6): corrections of pose, velocity and disturbance per unit of
            innovation of the same axis.
        decay: share (s, 6) of the estimated disturbance that remains after each of s steps.
        by_velocity: whether innovations are those of velocities; poses are then taken as measured.
    """

    readings: Sequence[Array]
    seen: Array
    known: Array
    time: Array
    ends: Array
    gains: Array
    decay: Array
    by_velocity: bool
