"""When a run is read, and the steps that models take from reading to reading."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.signals.chain import Stage
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.motion import Motion, Poses
from rovsim.simulation.step_grid import StepGrid

# Frames are read in groups of about this length: what a vehicle of this size does is slower than
# 5 Hz, and so are its propellers (5 / s, docs/simulator.md).
GROUP_SECONDS = 0.05  # s
LEAST_GROUP_SECONDS = 0.02  # s: of what is slower than 5 Hz, a tenth of a period
# A mean over T of what accelerates by a is off by a T^2 / 24, a step over T by about as much. Where
# an attitude loop shakes a vehicle by 12 rad/s2, that is 1.2 mrad in 50 ms, and a delay of 0.080 s
# in the loop was one of 0.074 s and a lag of 0.006 s, at p = 1. A tenth of the noise of usual
# readings (1 mm, 3 mrad: noise.py) may be lost.
MAX_LOST = np.array([1e-4] * 3 + [3e-4] * 3)  # m, rad
USUAL_SHARE = 0.68  # of a normal distribution within one standard deviation: hits do not count


@dataclass(frozen=True, eq=False)
class Steps:
    """When a run is read, and over which steps models go from reading to reading.

    Replays take steps between `grid` (k+1,) s; `at` (n,) those at which the samples or bins begin.
    `frames` (n, 13): pose NED before the filter, and mean velocity since the frame before where
    velocities were measured; `group` of them, an odd number, make a reading, which holds at one
    of the `reading_steps` (k,) of the observer. Its steps are `edges` (s+1,) s, each made of
    `substeps` (s,) of one length, over each of which the thrust is steady. Groups and steps take
    about `group_seconds`.
    """

    grid: Array
    at: Array
    frames: Array
    group: int
    reading_steps: Array
    edges: Array
    substeps: Array
    group_seconds: float


def choose_group_seconds(motion: Motion) -> float:
    """How long groups of frames of a run may be, s: shorter where it moves fast.

    Runs that are compared need groups of the same length, the shortest. Bins are readings as they
    are.
    """
    usable = np.nan_to_num(motion.nu_dot[motion.usable])
    if motion.binned or not len(usable):
        return GROUP_SECONDS
    usual = np.quantile(np.abs(usable), USUAL_SHARE, axis=0)
    lengths = np.sqrt(24.0 * MAX_LOST / np.maximum(usual, np.finfo(float).tiny))
    return float(np.clip(lengths.min(), LEAST_GROUP_SECONDS, GROUP_SECONDS))


def divide_run(stage: Stage, motion: Motion, grid: StepGrid, group_seconds: float) -> Steps:
    """The steps of a run.

    Args:
        stage: its poses before the filter, or a binned recording.
        motion: the same run, differentiated.
        grid: that of a replay.
        group_seconds: about how long groups of frames, and steps, take.
    """
    return (_step_bins if motion.binned else _step_samples)(stage, motion, grid, group_seconds)


def _step_bins(stage: Stage, motion: Motion, grid: StepGrid, seconds: float) -> Steps:
    """Every bin is a reading: the pose where it ends, and the mean velocity over it."""
    begins = np.round((motion.time - motion.time[0]) / grid.h).astype(int)
    frames = np.hstack([motion.eta, np.vstack([np.zeros(6), motion.nu[:-1]])])
    steps, ends = _divide(begins, seconds / grid.h)
    edges = motion.time[0] + grid.h * steps
    return Steps(edges, ends, frames, 1, ends, edges, np.diff(steps), seconds)


def _divide(at: Array, most: float) -> tuple[Array, Array]:
    """Whole numbers (s+1,) that divide each space between `at` (k,) evenly, and places of `at`.

    Into as many spaces as come closest to `most` each, which may be 1.
    """
    count = np.maximum(1, np.round(np.diff(at) / most)).astype(int)
    ends = np.concatenate([[0], np.cumsum(count)])
    number = np.arange(ends[-1]) - np.repeat(ends[:-1], count)
    offset = number * np.repeat(np.diff(at), count) // np.repeat(count, count)
    return np.append(np.repeat(at[:-1], count) + offset, at[-1]), ends


def _step_samples(stage: Stage, motion: Motion, grid: StepGrid, seconds: float) -> Steps:
    """A group of frames is a reading, and one step leads from it to the next."""
    assert isinstance(stage, Poses)
    count, period = len(motion.time), time_step(motion.time)
    group = 2 * round(0.5 * (seconds / period - 1.0)) + 1 if period < seconds else 1
    readings = count // group
    steps, ends = _divide(np.arange(readings) * group * grid.stride, seconds / grid.h)
    edges = motion.time[0] + group // 2 * period + grid.h * steps
    frames = np.hstack([stage.eta, np.zeros((count, 6))])
    at = np.arange(count) * grid.stride
    return Steps(grid.edges, at, frames, group, ends, edges, np.diff(steps), seconds)
