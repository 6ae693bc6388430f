"""Rough, robust velocities on an even clock, good enough to compare recordings with each other."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import continuous, normalized, turns, unrotate
from rovsim.measurement.recording.channels import Channel, Channels
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.clock import time_step

# A vehicle's speed answers within tenths of a second; a median over a step rejects single outliers.
MIN_STEP_S = 0.05
MAX_STEPS = 20_000  # a quarter of an hour is as good for a comparison as a day
MAX_GAP_S = 0.3  # without a pose over which a straight line still serves
# Lines over this many steps to either side: their slope is the velocity.
HALF_WINDOW = 3


@dataclass(frozen=True, eq=False)
class ResampledPoses:
    """Poses on an even clock; NaN where unknown.

    Attributes:
        time: (n,) s.
        position: (n, 3) m, in the axes of their source.
        attitude: (n, 4), unit quaternions from body to world.
    """

    time: Array
    position: Array
    attitude: Array


@dataclass(frozen=True, eq=False)
class Velocities:
    """Body velocities on an even clock.

    Attributes:
        time: (n,) s.
        nu: (n, 6), m/s and rad/s, along the body axes of their source; NaN where unknown.
    """

    time: Array
    nu: Array


def even_poses(export: Export | Recording) -> ResampledPoses:
    """Take medians of the found poses over the steps of an even clock, and bridge short gaps."""
    tracked = export.tracked
    time, position, attitude = (
        export.time[tracked],
        export.position[tracked],
        continuous(export.attitude[tracked]),
    )
    clock = even_clock(time)
    step = clock[1] - clock[0]
    bins = np.floor((time - clock[0]) / step + 0.5).astype(int)
    inside = bins < len(clock) + 1
    medians = _medians(bins[inside], np.column_stack([time, position, attitude])[inside])
    valid = np.flatnonzero(np.isfinite(medians).all(axis=1))
    filled = np.stack(
        [np.interp(clock, medians[valid, 0], c) for c in medians[valid, 1:].T], axis=1
    )
    filled[_far(clock, time)] = np.nan
    return ResampledPoses(clock, filled[:, :3], normalized(filled[:, 3:]))


def even_clock(time: Array) -> Array:
    """Make an even clock over times (n,) s, with at most `MAX_STEPS` steps.

    Its step is `MIN_STEP_S`, or the median step of the times if that is longer.
    """
    step = max(MIN_STEP_S, float(np.median(np.diff(time))))
    count = min(max(int((time[-1] - time[0]) / step) + 1, 2), MAX_STEPS)
    return time[0] + step * np.arange(count)


def _medians(bins: Array, values: Array) -> Array:
    """Median of the rows of each bin; NaN for bins without a row.

    Args:
        bins: the bin of each of m rows (m,), increasing.
        values: the rows (m, c).

    Returns:
        The medians (b, c) of bins 0 to b - 1.
    """
    unique_bins, starts, counts = np.unique(bins, return_index=True, return_counts=True)
    medians = np.full((bins[-1] + 1, values.shape[1]), np.nan)
    for count in np.unique(counts):  # all bins with the same number of rows at once
        same_count = counts == count
        rows = starts[same_count][:, None] + np.arange(count)
        medians[unique_bins[same_count]] = np.median(values[rows], axis=1)
    return medians


def _far(clock: Array, time: Array) -> Array:
    """Mask (n,) of the instants of a clock (n,) that lie in a long gap of the times (m,)."""
    after = np.clip(np.searchsorted(time, clock), 1, len(time) - 1)
    step = clock[1] - clock[0]
    return time[after] - time[after - 1] > max(MAX_GAP_S, 2.0 * step)


def estimate_velocities(export: Export | Recording) -> Velocities:
    """Take body velocities as exported, else from slopes of full poses, else from the channels."""
    if export.nu is not None:
        return _exported(export)
    if not export.tracked.any():
        return _of_channels(export.channels)
    return of_poses(even_poses(export))


def of_poses(poses: ResampledPoses) -> Velocities:
    """Take body velocities from slopes of poses."""
    linear = unrotate(poses.attitude, slopes(poses.time, poses.position))
    return Velocities(poses.time, np.hstack([linear, _rates(poses.time, poses.attitude)]))


def _exported(export: Export | Recording) -> Velocities:
    tracked, clock = export.tracked, even_clock(export.time[export.tracked])
    assert export.nu is not None
    nu = _interpolated(clock, export.time[tracked], export.nu[tracked])
    return Velocities(clock, nu)


def _of_channels(channels: Channels) -> Velocities:
    """Take body velocities from channels; columns that were not measured are NaN throughout."""
    times = [c.time for c in channels.values() if len(c.time) > 1]
    clock = even_clock(np.unique(np.concatenate(times)))
    nu = np.full((len(clock), 6), np.nan)
    if "velocity" in channels:
        nu[:, :3] = _interpolated(clock, *_whole(channels["velocity"]))
    if "rates" in channels:
        nu[:, 3:] = _interpolated(clock, *_whole(channels["rates"]))
    elif "attitude" in channels and len(channels["attitude"].time) > 1:
        attitude = channels["attitude"]
        q = normalized(_interpolated(clock, attitude.time, continuous(attitude.value)))
        nu[:, 3:] = _rates(clock, q)
    return Velocities(clock, nu)


def _whole(channel: Channel) -> tuple[Array, Array]:
    complete = np.isfinite(channel.value).all(axis=1)
    return channel.time[complete], channel.value[complete]


def _interpolated(clock: Array, time: Array, values: Array) -> Array:
    if len(time) < 2:
        return np.full((len(clock), values.shape[1]), np.nan)
    resampled = np.stack([np.interp(clock, time, c) for c in values.T], axis=1)
    resampled[_far(clock, time)] = np.nan
    return resampled


def _rates(time: Array, attitude: Array) -> Array:
    """Angular velocities (n, 3) rad/s in body axes, from attitudes (n, 4) at even times (n,) s."""
    rotation = turns(attitude)
    return smooth(np.vstack([rotation, rotation[-1:]]) / time_step(time))


def slopes(time: Array, values: Array) -> Array:
    """Slopes (n, c) of straight lines through each value (n, c) and its neighbours; NaN at ends."""
    step, k = time_step(time), np.arange(-HALF_WINDOW, HALF_WINDOW + 1)
    return _windowed(values, k[::-1] / (step * np.sum(k**2)))


def smooth(values: Array) -> Array:
    """Means (n, c) over each value (n, c) and its neighbours; NaN at the ends."""
    count = 2 * HALF_WINDOW + 1
    return _windowed(values, np.ones(count) / count)


def _windowed(values: Array, weights: Array) -> Array:
    filtered = np.full(values.shape, np.nan)
    inside = slice(HALF_WINDOW, len(values) - HALF_WINDOW)
    if len(values) >= len(weights):
        for k, column in enumerate(values.T):
            filtered[inside, k] = np.convolve(column, weights, mode="valid")
    return filtered
