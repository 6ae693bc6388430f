"""Readings that correct models while they run along a recording."""

from typing import NamedTuple

from numpy import ndarray as Array


class Correction(NamedTuple):
    """Readings, and the filters that correct models by them, as the compiled engine reads them.

    Attributes:
        readings: r series of k readings (r, k, 13): pose in NED, and the mean body velocity since
            the previous reading.
        row: (m,) which of the r series belongs to each of m models.
        seen: (k, 6) 1 for the axes that each reading measures, else 0.
        known: (5,) which parts of a pose were measured, see `pose_error` of the engine.
        time: (s+1,) at which the steps begin and end, s.
        ends: (k,) the time of each reading, as an index into `time`.
        gains: filter gains (3, 6): corrections of pose, velocity and disturbance per unit of
            innovation of the same axis.
        decay: share (s, 6) of the estimated disturbance that remains after each of s steps.
        by_velocity: whether innovations are those of the mean velocity, and measured poses are
            taken as true; otherwise innovations are those of the pose.
    """

    readings: Array
    row: Array
    seen: Array
    known: Array
    time: Array
    ends: Array
    gains: Array
    decay: Array
    by_velocity: bool
