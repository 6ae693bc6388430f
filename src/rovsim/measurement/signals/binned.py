"""Recordings that come as bin means of velocity, and model velocities averaged likewise.

Contract, section 3: nothing is filtered; the model is averaged over each bin; acceleration is
(v_k - v_{k-1}) / (t_k - t_{k-1}) for both.
"""

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.core.errors import BadInput
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.clock import find_stretches
from rovsim.measurement.signals.motion import Motion

# A bin this many median bins long has rows missing in it. Bins of 0.1 to 0.3 s occur side by side
# in the KTH tank's recordings, where the median is 0.19 s.
MAX_BIN_RATIO = 2.5


def bin_motion(recording: Recording) -> Motion:
    """Make a motion from a recording whose velocities are means over bins.

    Pose and velocity at the start of a bin come from `edge_values`: the recorded poses are bin
    means too. Not usable are rows with a missing number, rows whose bin is over `MAX_BIN_RATIO`
    median bins, the first row of each stretch (its starting state would be an extrapolation), and
    the last row (the end of its bin is unknown). Nothing is interpolated across unusable rows.

    Raises:
        BadInput: the recording holds no velocities or fewer than two rows.
    """
    if recording.nu is None or len(recording.time) < 2:
        raise BadInput(
            f"{len(recording.time)} rows" + ("" if recording.nu is not None else ", no velocities"),
            where=f"run {recording.run.id}",
            expected="at least two rows with body velocities",
            remedy="Check the export of this run, or take it out of campaign.yaml.",
        )
    time, nu = recording.time, recording.nu
    length = np.diff(time)
    end = float(time[-1] + np.median(length))
    edges = np.append(time, end)
    usable = recording.tracked & np.isfinite(nu).all(axis=1)
    usable = usable & (np.diff(edges) <= MAX_BIN_RATIO * np.median(length))
    usable[-1] = False
    eta, state_nu = _states(recording, nu, edges, usable)
    usable = usable & np.append(False, usable[:-1])
    return Motion(
        recording.run,
        recording.site,
        time,
        eta,
        nu,
        backward_difference(nu, time),
        state_nu,
        usable,
        recording.commands,
        binned=True,
        end=end,
    )


def edge_values(edges: Array, means: Array) -> Array:
    """Reconstruct the values (n, c) at the start of each bin from means over the bins.

    They are the derivative of the cubic spline through the running integral: its mean over every
    bin is the given one, and parabolas are exact. A shape-preserving cubic would go to zero
    wherever the sign changes: its error is 0.11 m/s, that of the spline 0.002 m/s, for a sine of
    1 m/s at 0.5 Hz in bins of 0.1 and 0.2 s.

    Args:
        edges: times (n + 1,) s between which the bins lie, increasing.
        means: mean (n, c) of each of c series over each bin.
    """
    length = np.diff(edges)[:, None]
    integral = np.concatenate([np.zeros((1, means.shape[1])), np.cumsum(means * length, axis=0)])
    return np.asarray(scipy.interpolate.CubicSpline(edges, integral)(edges[:-1], 1))


def bin_means(time: Array, nu: Array, edges: Array) -> Array:
    """Average velocities (..., n, 6) over bins, taking them as linear from sample to sample.

    Args:
        time: times (m,) s of the samples, increasing.
        nu: body velocities (..., m, 6) at these times, m/s and rad/s.
        edges: times (n + 1,) s between which the bins lie, increasing.

    Returns:
        The means; NaN for bins that the samples do not cover.
    """
    step = np.diff(time)[:, None]
    area = np.cumsum(0.5 * step * (nu[..., 1:, :] + nu[..., :-1, :]), axis=-2)
    area = np.concatenate([np.zeros_like(nu[..., :1, :]), area], axis=-2)
    slack = 1e-9 * max(1.0, abs(time[-1]))
    inside = (edges >= time[0] - slack) & (edges <= time[-1] + slack)
    clipped = np.clip(edges, time[0], time[-1])
    i = np.clip(np.searchsorted(time, clipped, side="right") - 1, 0, len(time) - 2)
    part = (clipped - time[i])[:, None]
    slope = (nu[..., i + 1, :] - nu[..., i, :]) / step[i]
    integral = area[..., i, :] + part * (nu[..., i, :] + 0.5 * part * slope)
    integral = np.where(inside[:, None], integral, np.nan)
    return np.diff(integral, axis=-2) / np.diff(edges)[:, None]


def backward_difference(nu: Array, time: Array) -> Array:
    """Acceleration (..., n, 6) of velocities: (nu_k - nu_{k-1}) / (t_k - t_{k-1}); NaN at k = 0."""
    nu_dot = np.full(np.shape(nu), np.nan)
    nu_dot[..., 1:, :] = np.diff(nu, axis=-2) / np.diff(time)[:, None]
    return nu_dot


def _states(recording: Recording, nu: Array, edges: Array, usable: Array) -> tuple[Array, Array]:
    """Pose (n, 7) and velocity (n, 6) at the start of each bin.

    Unusable rows stay as recorded; where their pose is missing it is the origin, unturned.
    """
    attitude = recording.attitude.copy()
    state = np.concatenate([recording.position, attitude, nu], axis=1)
    for start, end in find_stretches(usable):
        state[start:end, 3:7] = rotations.continuous(attitude[start:end])
        state[start:end] = edge_values(edges[start : end + 1], state[start:end])
    eta = state[:, :7]
    eta[~np.isfinite(eta).all(axis=1)] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    eta[:, 3:] = rotations.continuous(rotations.normalized(eta[:, 3:]))
    return eta, state[:, 7:]
