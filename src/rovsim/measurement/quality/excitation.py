"""How much a recording moves along each axis, and whether that suffices to judge the axis."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.core.errors import BadInput
from rovsim.core.robust import LONG_STEP
from rovsim.core.rotations import continuous, normalized, turns, unrotate
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.resample import Linear
from rovsim.measurement.signals.track import track_channels
from rovsim.results.quality import Excitation

BLOCK_S = 0.1  # the median of a block rejects single outlier frames
MIN_BLOCK_READINGS = 3.0  # of the slowest channel in a block: fewer are its noise
# An axis whose velocity varies less than this cannot be judged: on runs with no command on an
# axis, disturbances alone move it up to about 0.02 m/s and 0.1 rad/s.
MIN_SPREAD = np.array([0.03, 0.03, 0.03, 0.12, 0.12, 0.12])  # m/s, rad/s; std


def measure_excitation(recording: Recording) -> dict[str, Excitation]:
    """Standard deviation of the body velocity per axis, and whether it suffices to judge it.

    Axes that were not measured are left out.
    """
    nu, measured = _velocity(recording)
    spread = nu.std(axis=0) if len(nu) else np.zeros(6)
    return {
        axis: Excitation(
            std=float(spread[k]),
            unit=VELOCITY_UNITS[k],
            excited=bool(spread[k] > MIN_SPREAD[k]),
        )
        for k, axis in enumerate(AXES)
        if measured[k]
    }


def _velocity(recording: Recording) -> tuple[Array, Array]:
    """Rough body velocities (k, 6), m/s and rad/s, and which axes, bool (6,), were measured."""
    if recording.posed:
        return rough_velocity(recording), np.ones(6, bool)
    try:
        poses = track_channels(recording, Linear())
    except BadInput:  # no channel of the motion: this error is reported when the run is used
        return np.empty((0, 6)), np.zeros(6, bool)
    assert poses.measured is not None
    length = max(BLOCK_S, MIN_BLOCK_READINGS * poses.measured.period)
    columns = poses.time[:, None], poses.eta[:, :3], poses.eta[:, 3:]
    used = tuple(column[poses.usable] for column in columns)
    return _differences(*used, rate=1.0 / time_step(poses.time), length=length), poses.measured.axes


def rough_velocity(recording: Recording) -> Array:
    """Body velocities (k, 6): the exported ones, else differences of medians of short blocks."""
    if recording.nu is not None:
        return recording.nu[recording.tracked]
    return _differences(*select_found_poses(recording), rate=recording.rate, length=BLOCK_S)


def _differences(
    time: Array, position: Array, attitude: Array, *, rate: float, length: float
) -> Array:
    """Body velocities (k, 6), m/s and rad/s, from differences of medians of blocks of poses.

    Args:
        time: (n, 1), s.
        position: (n, 3), NED, m.
        attitude: (n, 4), unit quaternions, sign-continuous.
        rate: of the poses, Hz.
        length: of a block, s.
    """
    size = max(1, round(length * rate))
    time, position, attitude = (_blocks(a, size) for a in (time, position, attitude))
    step = np.diff(time[:, 0])
    contiguous = step < LONG_STEP * size / rate  # no difference across a gap
    dt = step[:, None]
    linear = unrotate(attitude[:-1], np.diff(position, axis=0) / dt)
    return np.hstack([linear, turns(attitude) / dt])[contiguous]


def select_found_poses(recording: Recording) -> tuple[Array, Array, Array]:
    """Select the frames in which the body was found.

    Returns:
        Time (k, 1), s; position (k, 3), NED, m; sign-continuous attitude (k, 4).
    """
    tracked = recording.tracked
    attitude = continuous(recording.attitude[tracked])
    return recording.time[tracked][:, None], recording.position[tracked], attitude


def _blocks(values: Array, size: int) -> Array:
    """Medians of consecutive blocks of `size` rows; unit length where the rows are quaternions."""
    count = len(values) // size
    medians = np.median(values[: count * size].reshape(count, size, values.shape[1]), axis=1)
    return normalized(medians) if values.shape[1] == 4 else medians
