"""Find single frames that are far from a cubic through their neighbours."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

NEIGHBOUR_FRAMES, OUTLIER_MEDIANS = 7, 6.0  # to either side; times their median count as far
MAX_NEIGHBOUR_STEPS = 3.5  # neighbours may be as far apart: two frames are lost between them


@dataclass(frozen=True, eq=False)
class Neighbours:
    """For each of n frames, the cubic through the two frames to either side of it.

    Attributes:
        time: times (n,) of the frames, s.
        weights: (4, n - 4), for all but the two frames at either end: the weights with which the
            values of the four neighbours add up to the cubic's value at the frame; NaN beside gaps.
        stop: (n,) s; the cubic misses a vehicle that stops dead at the frame by its speed times
            this. NaN at the ends and beside gaps.
    """

    time: Array
    weights: Array
    stop: Array

    @staticmethod
    def of(time: Array, step: float) -> "Neighbours":
        """Find the cubics of frames at `time` (n,) that are usually `step` s apart."""
        dt = np.stack([time[node] - time[2:-2] for node in _NODES])
        weights = np.ones_like(dt)
        for k, j in np.argwhere(~np.eye(4, dtype=bool)):
            weights[k] *= dt[j] / (dt[j] - dt[k])
        longest_step = np.diff(np.insert(dt, 2, 0.0, axis=0), axis=0).max(axis=0)
        weights[:, longest_step >= MAX_NEIGHBOUR_STEPS * step] = np.nan
        return Neighbours(time, weights, _padded(np.abs(np.sum((weights * dt)[2:], axis=0))))

    def beside(self, x: Array) -> Array:
        """Distance (n,) of each row of `x` (n, c) from its cubic; NaN where there is none."""
        expected = sum(w[:, None] * x[node] for w, node in zip(self.weights, _NODES, strict=True))
        return _padded(np.linalg.norm(x[2:-2] - expected, axis=1))


_NODES = [slice(0, -4), slice(1, -3), slice(3, -1), slice(4, None)]


def _padded(inner: Array) -> Array:
    return np.pad(inner, 2, constant_values=np.nan)


def find_far(off: Array, limit: Array) -> Array:
    """Find single outliers by their distance from the cubic through their neighbours.

    A frame is one if it is further off than its limit, further than the two frames to either side
    (whose cubics an outlier spoils, too), and over `OUTLIER_MEDIANS` times as far as the median of
    the frames nearby. If the next frame on either side has no cubic, that one may be the outlier:
    then none is reported.

    Args:
        off: distance (n,) of each frame from its cubic; NaN where it has none.
        limit: largest plausible distance (n,).

    Returns:
        Mask (n,), True for outliers.
    """
    padded = np.pad(off, NEIGHBOUR_FRAMES, constant_values=np.nan)
    nearby = np.lib.stride_tricks.sliding_window_view(padded, 2 * NEIGHBOUR_FRAMES + 1)
    outliers = np.zeros(len(off), bool)
    for k in np.flatnonzero(off > limit):
        window = nearby[k, NEIGHBOUR_FRAMES - 2 : NEIGHBOUR_FRAMES + 3]
        outer = np.delete(nearby[k], slice(NEIGHBOUR_FRAMES - 2, NEIGHBOUR_FRAMES + 3))
        usual = np.median(outer[~np.isnan(outer)]) if not np.isnan(outer).all() else np.inf
        sure = np.isfinite(window[1:4]).all() and off[k] >= np.nanmax(window)
        outliers[k] = sure and off[k] > OUTLIER_MEDIANS * usual
    return outliers
