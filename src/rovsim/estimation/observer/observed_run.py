"""A run as the observer sees it: readings of the motion capture, before the filter."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.bounded_cache import Recent
from rovsim.core.rotations import normalized
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.mocap_view import NO_CHANGE, MocapView
from rovsim.estimation.kernels.axis import BIN_MEAN, POSE, SUM
from rovsim.estimation.observer.lost_lines import fill_lost_lines
from rovsim.estimation.observer.steps import GROUP_SECONDS, Steps, divide_run
from rovsim.measurement.signals.chain import Stage
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.measured import find_measured
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.drive import Drives
from rovsim.simulation.settings import ReplaySettings
from rovsim.simulation.step_grid import StepGrid

# The observer forgets where it started within a second: its bandwidth is about 1 Hz (noise.py).
SETTLING_SECONDS = 1.0  # s
# A velocity that nobody reads forgets its start by drag alone: within three times mass / drag, some
# 3 s for a small vehicle at usual speeds.
UNREAD_SETTLING_SECONDS = 9.0  # s
MIN_STRETCH_SECONDS = 2.0  # s; a shorter stretch would be mostly settling
BLOCK_SECONDS = 10.0  # s, many times the memory of turbulence, so that blocks are independent


@dataclass(frozen=True, eq=False)
class ObservedRun(Steps):
    """One run, ready to be observed.

    In each of the `segments`, a model starts at the measured state of the first reading, and is
    corrected by all readings up to the last one.

    Attributes:
        motion: the run, filtered and differentiated.
        drives: of models over the steps of the observer, with the lines that the log lost.
        replay_drives: of models over the steps of a replay: commands hold until the next line.
        wrenches: the wrench effects that models of the same task may have.
        free_axes: (6,) in which the vehicle can move at all.
        current_may_drift: whether a wandering current may be looked for.
    """

    motion: Motion
    drives: Drives
    replay_drives: Drives
    wrenches: tuple[type[Wrench], ...]
    free_axes: Array
    current_may_drift: bool = True

    def limited(self, kept: Array) -> "ObservedRun":
        """The same run, of which only the samples or bins in a mask (n,) are usable."""
        return replace(self, motion=replace(self.motion, usable=self.motion.usable & kept))

    def since_start(self, edges: Array) -> Array:
        """Times of the run as s since the start of the recording, of which it may be a part."""
        return self.motion.commands.since_start(edges)

    @cached_property
    def segments(self) -> tuple[tuple[int, int], ...]:
        """Numbers of the first and the last reading of every stretch that is long enough."""
        return tuple(
            (-(-a // self.group), b // self.group - 1)
            for a, b in self.motion.segments()
            if _is_long_enough(self.motion, a, b)
        )

    @cached_property
    def reading_samples(self) -> Array:
        """Sample or bin (k,) of the motion that each reading is of: the middle of its group."""
        return np.arange(len(self.reading_steps)) * self.group + self.group // 2

    def read(self, view: MocapView) -> Array:
        """Readings (k, 13), one for each group of frames, converted by `view`.

        A reading is the mean of its group, corrected for the curvature of the motion. Where sums of
        velocities are read, it is the middle frame: their noise adds up, and a mean would make the
        noise of one reading depend on that of the next.
        """
        return self._read_as_reported if view.key == NO_CHANGE.key else self._read(view)

    @cached_property
    def _read_as_reported(self) -> Array:
        return self._read(NO_CHANGE)

    def _read(self, view: MocapView) -> Array:
        period = self.frame_period
        sharp = view.sharpen(self.frames[:, :7], period)
        if self.group == 1:
            return view.states(np.hstack([sharp, self.frames[:, 7:]]))
        poses, smooth = view.poses(sharp), view.poses(view.sharpen(self.motion.eta, period))
        mean = self._average(poses) + smooth[self.reading_samples] - self._average(smooth)
        mean = np.where(self._summed, poses[self.reading_samples], mean)
        mean_poses = np.hstack([mean[:, :3], normalized(mean[:, 3:])])
        return np.hstack([mean_poses, np.zeros((len(mean_poses), 6))])

    @property
    def _summed(self) -> Array:
        """Mask (7,) of the numbers of a pose that are sums of velocities."""
        summed = self.reading_kinds == SUM
        return np.append(summed[:3], np.repeat(summed[3:].any(), 4))

    def _average(self, x: Array) -> Array:
        count = len(self.reading_steps)
        groups = x[: count * self.group].reshape(count, self.group, -1)
        total = groups[:, 0].copy()
        for k in range(1, self.group):  # `mean` over so short an axis takes three times as long
            total += groups[:, k]
        return np.asarray(total / self.group)

    @cached_property
    def step_lengths(self) -> Array:
        """Length (s,) of each step of the observer, s."""
        return np.diff(self.since_start(self.edges))

    @cached_property
    def reading_times(self) -> Array:
        """Time (k,) of each reading, s since the first step."""
        return self.edges[self.reading_steps] - self.edges[0]

    @cached_property
    def period(self) -> float:
        """Mean time between two readings, s."""
        return float(np.mean(np.diff(self.reading_times)))

    @property
    def pose_measured(self) -> Array:
        """What was measured (5,), 1 or 0: x, y, z, yaw, and whether only parts of the pose were.

        The engine's `pose_error` takes it in this form.
        """
        axes = self.motion.measured
        if axes is None:
            return np.array([1.0, 1.0, 1.0, 1.0, 0.0])
        return np.concatenate([axes.coordinates, axes.heading, [True]]).astype(float)

    @property
    def axes(self) -> Array:
        """Mask (6,) of the axes that were measured, and in which the vehicle can move."""
        return np.asarray(find_measured(self.motion.measured) & self.free_axes)

    @cached_property
    def reading_mask(self) -> Array:
        """Mask (k, 6) of the axes that each reading shows."""
        count, axes = len(self.reading_steps), self.motion.measured
        if axes is None:
            return np.tile(self.free_axes, (count, 1))
        frames = axes.when[: count * self.group]
        return np.asarray(frames.reshape(count, self.group, 6).any(axis=1) & self.free_axes)

    @cached_property
    def reading_kinds(self) -> Array:
        """Kind of the readings of each axis (6,): poses, means or sums, see `kernels.axis`."""
        if self.motion.binned:
            return np.full(6, BIN_MEAN)
        axes = self.motion.measured
        return np.full(6, POSE) if axes is None else np.where(axes.summed, SUM, POSE)

    @cached_property
    def axis_periods(self) -> Array:
        """Mean time (6,) between two readings of each axis, s; `period` for an axis without any."""
        count = self.reading_mask.sum(axis=0)
        periods = self.period * len(self.reading_mask) / np.maximum(count, 1)
        return np.where(count > 0, periods, self.period)

    @property
    def frame_period(self) -> float:
        """Mean time between two frames, s."""
        return self.period / self.group

    @cached_property
    def innovation_segments(self) -> Array:
        """First innovation of each segment, and the first one after it (s, 2)."""
        length = np.array([b - a for a, b in self.segments], np.int64)
        stops = np.cumsum(length)
        return np.column_stack([stops - length, stops])

    @cached_property
    def innovation_readings(self) -> Array:
        """Number (n,) of the reading behind each innovation."""
        return np.concatenate([np.arange(0), *(np.arange(a + 1, b + 1) for a, b in self.segments)])

    @cached_property
    def time(self) -> Array:
        """Time (n,) of each innovation, s since the first step."""
        return np.asarray(self.reading_times[self.innovation_readings])

    def overlapping(self, begin: float, end: float) -> Array:
        """Mask (n,) of innovations from which on one period overlaps the time `begin` to `end`."""
        return np.asarray((self.time < end) & (self.time + self.period > begin))

    @cached_property
    def innovation_mask(self) -> Array:
        """Mask (n, 6) of the axes that the reading behind each innovation shows."""
        return np.asarray(self.reading_mask[self.innovation_readings])

    @cached_property
    def innovation_samples(self) -> Array:
        """Sample or bin (n,) of the motion that each innovation belongs to."""
        samples = self.reading_samples[self.innovation_readings]
        return np.asarray(samples - (1 if self.motion.binned else 0))

    @cached_property
    def settled(self) -> Array:
        """Mask (n,) of the innovations that count: from when the filters have settled."""
        mask = np.zeros(len(self.time), bool)
        settling = SETTLING_SECONDS if self.axes[self.free_axes].all() else UNREAD_SETTLING_SECONDS
        for (begin, end), (a, _) in zip(self.innovation_segments, self.segments, strict=True):
            mask[begin:end] = self.time[begin:end] > self.reading_times[a] + settling
        return mask


def prepare_run(
    stage: Stage,
    motion: Motion,
    settings: ReplaySettings,
    catalogue: Catalogue,
    free: Array,
    kept: Recent | None = None,
    group_seconds: float = GROUP_SECONDS,
) -> ObservedRun:
    """Prepare a run for the observer; without usable stretches it has no segments.

    Args:
        stage: its poses on a uniform clock, before the filter; a binned recording as it is.
        motion: the same run, filtered and differentiated.
        settings: the longest integration step, and how commands are held.
        catalogue: the effects that may act in it.
        free: axes (6,) in which the vehicle can move.
        kept: where its drives are kept, perhaps with those of other runs.
        group_seconds: about how long the frames of a reading take, see `choose_group_seconds`.
    """
    grid = StepGrid.over(motion, settings.step)
    steps = divide_run(stage, motion, grid, group_seconds)
    fine_grid = np.linspace(steps.edges[0], steps.edges[-1], int(steps.substeps.sum()) + 1)
    commands = motion.commands
    sent = commands if motion.binned else fill_lost_lines(commands)
    drives = Drives(sent, fine_grid, settings.commands, steps.substeps, kept)
    replay_drives = drives
    if not motion.binned:
        replay_drives = Drives(commands, grid.edges, settings.commands, kept=kept)
    return ObservedRun(
        **vars(steps),
        motion=motion,
        drives=drives,
        replay_drives=replay_drives,
        wrenches=catalogue.wrenches,
        free_axes=free,
    )


def _is_long_enough(motion: Motion, a: int, b: int) -> bool:
    """Whether the stretch from sample or bin a to b - 1 is long enough to be observed."""
    if motion.binned:
        return bool(motion.time[b - 1] - motion.time[a] > MIN_STRETCH_SECONDS)
    return bool((b - a) * time_step(motion.time) > MIN_STRETCH_SECONDS)


def number_blocks(runs: Sequence[ObservedRun], seconds: float = BLOCK_SECONDS) -> Array:
    """Number (n,) of the block of time of each settled innovation, counted over all runs.

    A block lasts `seconds`, and belongs to one run.
    """
    parts, count = [np.arange(0)], 0
    for run in runs:
        number = (run.time[run.settled] / seconds).astype(int)
        numbers, index = np.unique(number, return_inverse=True)
        parts.append(index + count)
        count += len(numbers)
    return np.concatenate(parts)
