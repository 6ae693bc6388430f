"""The acceleration of a model at measured states (teacher forcing): it is not integrated."""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import normalized
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.batch import Batch
from rovsim.simulation.drive import Drive, drive_by_log
from rovsim.simulation.initial_memory import measured_memory
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.step_grid import StepGrid
from rovsim.simulation.unfiltered_motion import sharpen


def undo_mocap_view(model: Model, motion: Motion) -> Motion:
    """Compute the true motion of CO, if the motion capture reports it as the model says.

    This undoes smoothing, and the offset and rotation of the reported body and world axes.
    """
    motion, inverse = sharpen(model, motion), model.mocap_view.inverse
    return (
        motion
        if inverse.identity
        else replace(
            motion,
            eta=inverse.poses(motion.eta),
            nu=inverse.twists(motion.nu),
            nu_dot=inverse.twists(motion.nu_dot),
            state_nu=inverse.twists(motion.state_nu),
        )
    )


def true_states(model: Model, motion: Motion, index: Array) -> Array:
    """True states (k, 13), as of `undo_mocap_view`, at some samples or bins `index` (k,) alone."""
    view = model.mocap_view
    if motion.binned or (view.identity and not view.low_pass.time_constants):
        return undo_mocap_view(model, motion).state_at(index)
    states = np.empty((len(index), 13))
    for k, i in enumerate(index):  # each stage needs the sample before, or the one after the first
        first = max(int(i) - len(view.low_pass.time_constants), 0)
        window = undo_mocap_view(model, motion.part(slice(first, int(i) + 2)))
        states[k] = window.state[int(i) - first]
    return states


def interpolate_state(motion: Motion, time: float) -> Array:
    """Interpolate the state (13,) linearly between two samples or starts of bins; `time` in s."""
    state = interpolate(motion.time, motion.state, time)
    state[3:7] = normalized(state[3:7])
    return state


def interpolate(times: Array, values: Array, time: float) -> Array:
    """Interpolate `values` (..., n, c) at `times` (n,) linearly to one time: (..., c)."""
    k = int(np.clip(np.searchsorted(times, time) - 1, 0, len(times) - 2))
    share = (time - times[k]) / (times[k + 1] - times[k])
    return (1.0 - share) * values[..., k, :] + share * values[..., k + 1, :]


def accelerate_as_measured(model: Model, motion: Motion, drive: Drive) -> Array:
    """Evaluate the body acceleration of a model at the states of a true motion.

    Args:
        model: the model.
        motion: the run as the model sees it, see `undo_mocap_view`.
        drive: of the model at the n samples or starts of bins.

    Returns:
        Acceleration (n, 6), m/s2 and rad/s2.
    """
    memory = measured_memory(model, motion, motion.time)
    times = motion.commands.since_start(motion.time)
    return Batch([model], motion.site).accelerations(drive, times, motion.state, memory)


def accelerate_as_logged(model: Model, motion: Motion, settings: ReplaySettings) -> Array:
    """Do the same as `accelerate_as_measured`, under the logged commands of the run."""
    drive = drive_as_measured(model, motion, settings)
    return accelerate_as_measured(model, motion, drive)


def drive_as_measured(model: Model, motion: Motion, settings: ReplaySettings) -> Drive:
    """Average the drive of a model around every sample or start of a bin.

    Raises:
        BadInput: the run lacks what an effect of the model needs.
    """
    grid = StepGrid.over(motion, settings.step)
    drive = drive_by_log(model, motion, grid, settings.commands)
    if motion.binned:
        return _average_at_bins(drive, nearest_steps(motion, grid))
    return _average_at_samples(drive, grid.stride)


def _average_at_samples(drive: Drive, stride: int) -> Drive:
    """Average a drive over the two sampling periods around each sample of a uniform clock."""

    def mean(x: Array) -> Array:
        x = x.reshape(len(x) // stride, stride, x.shape[-1]).mean(axis=1)
        return 0.5 * (np.vstack([x[:1], x]) + np.vstack([x, x[-1:]]))

    return drive.each(mean)


def _average_at_bins(drive: Drive, nearest: Array) -> Drive:
    """Average a drive over the two bins around the start of each of n bins.

    Args:
        drive: over the integration steps.
        nearest: steps (n+1,) at which the bins begin, and the last one ends.
    """

    def mean(x: Array) -> Array:
        total = np.vstack([np.zeros(x.shape[-1]), np.cumsum(x, axis=0)])
        a, b = nearest[np.maximum(np.arange(len(nearest) - 1) - 1, 0)], nearest[1:]
        return (total[b] - total[a]) / np.maximum(b - a, 1)[:, None]

    return drive.each(mean)


def nearest_steps(motion: Motion, grid: StepGrid) -> Array:
    """Indices (n+1,) of the steps that are nearest to the starts of n bins and the last end."""
    edges = np.append(motion.time, motion.end)
    nearest = np.round((edges - edges[0]) / grid.h).astype(int)
    return np.clip(nearest, 0, len(grid.edges) - 1)
