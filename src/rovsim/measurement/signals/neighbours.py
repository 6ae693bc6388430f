"""Single frames that are not where their neighbours have them."""

import numpy as np
from numpy import ndarray as Array

OTHERS, FAR_MORE = 7, 6.0  # frames to either side, and how much more than their median is far


def beside_cubic(time: Array, x: Array, step: float) -> Array:
    """How far (n,) each of `x` (n, c) is from the cubic through two neighbours to either side.

    NaN at both ends, and where a neighbour is not there.
    """
    off = np.full(len(time), np.nan)
    nodes = [slice(0, -4), slice(1, -3), slice(3, -1), slice(4, None)]
    ago = [time[own] - time[2:-2] for own in nodes]
    expected = np.zeros_like(x[2:-2])
    for own, t in zip(nodes, ago, strict=True):
        weight = np.prod([other / (other - t) for other in ago if other is not t], axis=0)
        expected += weight[:, None] * x[own]
    whole = np.maximum.reduce(np.diff([*ago[:2], np.zeros(len(ago[0])), *ago[2:]], axis=0))
    off[2:-2] = np.where(whole < 1.5 * step, np.linalg.norm(x[2:-2] - expected, axis=1), np.nan)
    return off


def find_far(off: Array, limit: float) -> Array:
    """Where (n,) frames are further `off` (n,) than `limit`, and far more so than those nearby.

    An outlier shifts what is expected of two frames to either side, too: of these, the furthest.
    """
    padded = np.pad(off, OTHERS, constant_values=np.nan)
    nearby = np.lib.stride_tricks.sliding_window_view(padded, 2 * OTHERS + 1)
    far = np.zeros(len(off), bool)
    for k in np.flatnonzero(off > limit):
        own = nearby[k, OTHERS - 2 : OTHERS + 3]
        others = np.delete(nearby[k], slice(OTHERS - 2, OTHERS + 3))
        usual = np.median(others[~np.isnan(others)]) if not np.isnan(others).all() else np.inf
        far[k] = off[k] >= np.nanmax(own) and off[k] > FAR_MORE * usual
    return far
