"""What the water remembers of a measured motion, where a model has a fluid memory."""

from typing import Iterable, Sequence

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core.rotations import unrotate
from rovsim.dynamics.engine.types import NO_MEMORY
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion

STEP = 0.01  # s; the velocity is taken as straight between two samples, for which this is exact


def measured_memory(model: Model, motion: Motion, times: Array) -> Array:
    """Remembered velocity (k, 6) at times (k,) of a true motion; empty without a memory.

    Gaps are bridged by interpolation: the water does not forget what nobody saw. Samples count too
    that were seen and are left out of a comparison.
    """
    body = model.body
    known = np.flatnonzero(motion.usable | np.isfinite(motion.state_nu).all(axis=1))
    if body.forgets == 0.0:
        return NO_MEMORY
    if len(known) == 0:
        return np.zeros((len(times), 6))
    nu_r = motion.state_nu[known].copy()
    nu_r[:, :3] -= unrotate(motion.eta[known, 3:], body.current)
    count = max(1, int(np.ceil((times[-1] - motion.time[0]) / STEP - 1e-9)))
    grid = np.linspace(motion.time[0], times[-1], count + 1)
    h = float(grid[1] - grid[0])
    columns = (np.interp(grid, motion.time[known], column) for column in nu_r.T)
    remembered = [lag_of_lines(column, h * body.forgets) for column in columns]
    return np.stack([np.interp(times, grid, column) for column in remembered], axis=1)


def remembered_at(
    models: Sequence[Model], motions: Iterable[Motion], edges: Array, steps: Array
) -> Array:
    """What the water remembers (m, w, 6) at some steps (w,) of a grid; empty if it never does.

    `motions` are the same run, true as each model sees it; `edges` (k+1,) s those of the grid.
    """
    if not any(m.body.forgets for m in models):
        return NO_MEMORY
    rows = [measured_memory(m, run, edges) for m, run in zip(models, motions, strict=True)]
    return np.stack([r[steps] if r.size else np.zeros((len(steps), 6)) for r in rows])


def lag_of_lines(values: Array, step: float) -> Array:
    """First-order lag (k,), zero at the start, of straight lines through values (k,).

    `step` between two values is in time constants.
    """
    kept = np.exp(-step)
    mean = (1.0 - kept) / step
    end, begin = 1.0 - mean, mean - kept
    return scipy.signal.lfilter([end, begin], [1.0, -kept], values, zi=[-end * values[0]])[0]
