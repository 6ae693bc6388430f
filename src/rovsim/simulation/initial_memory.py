"""The state of a model's fluid memory while the vehicle moves as it was measured.

The memory is a velocity: the velocity relative to the water, passed through a first-order low-pass.
"""

from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import unrotate
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.dynamics.low_pass import LowPass
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion

STEP_S = 0.01  # the velocity is taken as straight between two samples, for which this is exact


def measured_memory(model: Model, motion: Motion, times: Array) -> Array:
    """Compute the state of a model's fluid memory at some times of a true motion.

    Gaps in the measurement are interpolated, since the water goes on moving in them. Samples that
    are left out of comparisons are used as well, if they were measured.

    Args:
        model: with its current and the time constant of its memory.
        motion: the run as the model sees it, see `undo_mocap_view`.
        times: (k,), s on the clock of the motion.

    Returns:
        Velocity (k, 6) in body axes, m/s and rad/s; empty where the model has no fluid memory.
    """
    body = model.body
    rows = np.flatnonzero(motion.usable | np.isfinite(motion.state_nu).all(axis=1))
    if body.memory_decay == 0.0:
        return NO_MEMORY
    if len(rows) == 0:
        return np.zeros((len(times), 6))
    nu_r = motion.state_nu[rows].copy()
    nu_r[:, :3] -= unrotate(motion.eta[rows, 3:], body.current)
    end = np.max(times, initial=motion.time[0] + STEP_S)
    count = int(np.ceil((end - motion.time[0]) / STEP_S - 1e-9))
    grid = np.linspace(motion.time[0], end, count + 1)
    h = float(grid[1] - grid[0])
    on_grid = np.stack([np.interp(grid, motion.time[rows], column) for column in nu_r.T], axis=1)
    wake = LowPass((1.0 / body.memory_decay,))
    remembered = wake.smooth(on_grid, h, first=np.zeros((1, 6)), straight=True)
    return np.stack([np.interp(times, grid, column) for column in remembered.T], axis=1)


def remembered_at(
    models: Sequence[Model], see: Callable[[Model], Motion], edges: Array, steps: Array
) -> Array:
    """Compute the states of the fluid memories of m models at some steps of a grid.

    Models whose memory depends on the same numbers share one computation.

    Args:
        models: m of them.
        see: returns the true motion of the run behind the measured one, for one model.
        edges: (k+1,) at which the steps of the grid begin and end, s.
        steps: indices (w,) into `edges`.

    Returns:
        Velocities (m, w, 6), m/s and rad/s; zero for models without a fluid memory, and empty where
        no model has one.
    """
    if not any(m.body.memory_decay for m in models):
        return NO_MEMORY
    keys = [_name_memory(m) for m in models]
    states = {
        k: measured_memory(m, see(m), edges[steps])
        for k, m in dict(zip(keys, models, strict=True)).items()
    }
    return np.stack([states[k] if states[k].size else np.zeros((len(steps), 6)) for k in keys])


def _name_memory(model: Model) -> tuple:
    """Key of all numbers of a model that the state of its fluid memory depends on."""
    return model.mocap_view.key, model.body.memory_decay, model.body.current.tobytes()
