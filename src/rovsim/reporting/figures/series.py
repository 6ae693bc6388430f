"""Prepare time series for paper: keep gaps, cut long runs to an excerpt, limit the axes."""

from typing import Iterable

import numpy as np
from numpy import ndarray as Array

EXCERPT_S = 60.0  # at 150 mm width still 0.4 s per millimetre
GAP_STEPS = 3.0  # a step longer than this many median steps is a gap
HEADROOM_RATIO = 2.5  # a diverging model may use this many times the measured range, no more


def broken(time: Array, values: Array) -> tuple[Array, Array]:
    """Put a NaN row into `values` (n, ...) wherever `time` (n,) jumps: no line bridges it."""
    steps = np.diff(time)
    if not len(steps):
        return time, values
    jumps = np.flatnonzero(steps > GAP_STEPS * np.median(steps)) + 1
    middle = 0.5 * (time[jumps] + time[jumps - 1])
    return np.insert(time, jumps, middle), np.insert(values, jumps, np.nan, axis=0)


def masked(values: Array, usable: Array | None) -> Array:
    """Return a copy of `values` (n, ...) with NaN where `usable` (n,) is False."""
    values = np.array(values, dtype=float)
    if usable is not None:
        values[~np.asarray(usable, dtype=bool)] = np.nan
    return values


def averaged(time: Array, values: Array, seconds: float) -> Array:
    """Return means of `values` (n, ...) over so many seconds around each sample; NaN stays NaN."""
    if len(time) < 2:
        return values
    half = max(0, round(0.5 * seconds / float(np.median(np.diff(time)))))
    valid = np.isfinite(values)
    sums, counts = (
        np.pad(np.cumsum(x, axis=0, dtype=float), [(1, 0)] + [(0, 0)] * (values.ndim - 1))
        for x in (np.where(valid, values, 0.0), valid)
    )
    k = np.arange(len(time))
    low, high = np.maximum(k - half, 0), np.minimum(k + half + 1, len(time))
    return np.where(
        valid, (sums[high] - sums[low]) / np.maximum(counts[high] - counts[low], 1), np.nan
    )


def excerpt(time: Array, values: Array, length: float = EXCERPT_S) -> slice:
    """Return the samples of the excerpt of `length` s with most motion; all of a shorter run.

    Motion is the sum of the absolute values, each axis divided by its own RMS; NaN counts nothing.

    Args:
        time: of the samples (n,), s.
        values: at these (n, k).
        length: s.
    """
    if not len(time) or time[-1] - time[0] <= length:
        return slice(0, len(time))
    spread = np.sqrt(np.nanmean(np.where(np.isfinite(values), values, 0.0) ** 2, axis=0))
    share = np.abs(values) / np.where(spread > 0, spread, 1.0)
    lively = np.concatenate([[0.0], np.cumsum(np.nan_to_num(share).sum(axis=1))])
    first = np.searchsorted(time, np.arange(time[0], time[-1] - length + 1e-9, 5.0))
    last = np.searchsorted(time, time[first] + length, side="right")
    best = int(np.argmax(lively[last] - lively[first]))
    return slice(int(first[best]), int(last[best]))


def limits(reference: Array, others: Iterable[Array]) -> tuple[float, float]:
    """Return the limits of an axis that shows `reference`; `others` may go beyond them."""
    stacked = [a[np.isfinite(a)] for a in (reference, *others)]
    everything = np.concatenate(stacked)
    if not len(everything):
        return -1.0, 1.0
    base = stacked[0] if len(stacked[0]) else everything
    low, high = float(base.min()), float(base.max())
    room = max(high - low, 1e-6) * (HEADROOM_RATIO - 1) / 2
    visible = everything[(everything >= low - room) & (everything <= high + room)]
    margin = 0.05 * max(float(np.ptp(visible)), 1e-6)
    return float(visible.min()) - margin, float(visible.max()) + margin
