"""Velocities that nobody measured: each replay goes on with those of the one before it."""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import Drive


def propagate_unmeasured_velocities(
    batch: Batch, drives: Sequence[Drive], starts: Starts, time: Array, measured: Array
) -> Starts:
    """The same starts, with the velocities that each model itself has by then where none was read.

    A recording of depth and attitude does not say how fast the vehicle swims; taken for zero, even
    a perfect model would be wrong for as long as its drag needs. Before the first start it rests.

    Args:
        batch: of m models.
        drives: of each.
        starts: w of them, in order of time.
        time: (k+1,) s at which the integration steps begin and end.
        measured: axes (6,) whose velocity was.
    """
    unread = ~measured & (batch.free[7:] > 0.0)
    if not unread.any():
        return starts
    state = starts.state.copy()
    for k, steps in enumerate(np.diff(starts.first)):
        one = slice(k, k + 1)
        memory = starts.memory[:, one] if starts.memory.size else starts.memory
        until = Starts(state[:, one], starts.first[one], np.array([steps]), memory)
        ends = [of_model[0][-1, 7:] for of_model in batch.trajectories(drives, until, time, steps)]
        gone = unread & np.isfinite(ends)  # what diverged starts anew
        state[:, k + 1, 7:] = np.where(gone, ends, state[:, k + 1, 7:])
    return replace(starts, state=state)
