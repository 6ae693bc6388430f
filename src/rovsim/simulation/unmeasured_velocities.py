"""Velocities that were not measured: each window begins with those that the model has by then."""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.simulation.batch import Batch, Starts
from rovsim.simulation.drive import Drive


def propagate_unmeasured_velocities(
    batch: Batch, drives: Sequence[Drive], starts: Starts, time: Array, measured: Array
) -> Starts:
    """Replace unmeasured velocities of starts by those that each model reaches by then.

    A recording of depth and attitude alone does not say how fast the vehicle moves. If each window
    began with zero velocity, even a perfect model would be wrong for as long as drag needs to make
    it forget. So each model is simulated from one start to the next. The velocity at the first
    start stays as given.

    Args:
        batch: of m models.
        drives: one for each model.
        starts: w of them for each model, in order of time.
        time: (k+1,) s at which the integration steps begin and end.
        measured: boolean (6,): axes whose velocity was measured.
    """
    unmeasured = ~measured & (batch.free[7:] > 0.0)
    if not unmeasured.any():
        return starts
    state = starts.state.copy()
    for k, steps in enumerate(np.diff(starts.first)):
        row = slice(k, k + 1)
        memory = starts.memory[:, row] if starts.memory.size else starts.memory
        segment = Starts(state[:, row], starts.first[row], np.array([steps]), memory)
        ends = [path[0][-1, 7:] for path in batch.trajectories(drives, segment, time, steps)]
        replaced = unmeasured & np.isfinite(ends)  # what diverged starts anew
        state[:, k + 1, 7:] = np.where(replaced, ends, state[:, k + 1, 7:])
    return replace(starts, state=state)
