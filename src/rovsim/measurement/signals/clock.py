"""Uniform clocks and the usable stretches on them."""

import numpy as np
from numpy import ndarray as Array


def uniform_clock(first: float, last: float, rate: float) -> Array:
    """Times (n,) s from `first` to at most `last`, 1 / `rate` apart."""
    return first + np.arange(int((last - first) * rate + 1e-6) + 1) / rate


def time_step(time: Array) -> float:
    """Step in s of a uniform clock (n,), n > 1."""
    return float((time[-1] - time[0]) / (len(time) - 1))


def find_stretches(usable: Array) -> list[tuple[int, int]]:
    """Stretches [first, last) of True in `usable` (n,), in order."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], usable, [0]]).astype(int)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def without_short(usable: Array, length: int) -> Array:
    """`usable` (n,) without its stretches of fewer than `length` samples."""
    mask = usable.copy()
    for start, end in find_stretches(usable):
        mask[start:end] = end - start >= length
    return mask


def without_margins(usable: Array, samples: int) -> Array:
    """`usable` (n,) with every stretch shortened by `samples` at either end."""
    mask = np.zeros_like(usable)
    for start, end in find_stretches(usable):
        mask[start + samples : max(end - samples, start + samples)] = True
    return mask
