"""First-order Gauss-Markov noise of unit variance: correlation falls off as exp(-t / T).

    x(t + h) = a x(t) + sqrt(1 - a^2) w,   a = exp(-h / T),   w ~ N(0, 1)

is exact at the instants, however long the step (Gillespie 1996, Phys. Rev. E 54, 2084: the
Ornstein-Uhlenbeck process). Steps are counted in correlation times T; callers scale.
"""

from itertools import accumulate

import numpy as np
from numpy import ndarray as Array


def decay(step: Array | float) -> Array:
    """The factor a of a step."""
    return np.asarray(np.exp(-step))


def propagate(a: Array, normal: Array, begin: Array) -> Array:
    """Values (n, ..., c) after each of n steps from `begin` (..., c) on.

    Args:
        a: of the steps: one number or (c,); of steps that differ (n, ..., c), as broadcast.
        normal: standard normal numbers (n, ..., c), perhaps scaled; then so are the values.
        begin: where it starts.
    """
    kicks = normal * np.sqrt(1.0 - a * a)
    return lag(a, kicks, begin) if a.ndim < 2 else _lag_by_rows(a, kicks, begin)


def draw(steps: int, step: float, random: np.random.Generator) -> Array:
    """Six channels (steps, 6) of unit variance, stationary; `step` in correlation times."""
    normal = random.normal(size=(steps, 6))
    return propagate(decay(step), normal, random.normal(size=6))


def lag(a: Array, kicks: Array, begin: Array) -> Array:
    """x = a x + kick, row by row of the kicks (n, c), from x = begin (c,) on; `a` one, or (c,)."""
    each = zip(np.broadcast_to(a, begin.shape), begin, kicks.T, strict=True)
    return np.stack([_lag_column(float(a), float(first), own) for a, first, own in each], axis=1)


def _lag_column(a: float, begin: float, kicks: Array) -> Array:
    # In Python's floats: faster than rows of NumPy, and SciPy's filter takes a second to import.
    column = accumulate(kicks.tolist(), lambda x, kick: a * x + kick, initial=begin)
    next(column)
    return np.fromiter(column, float, len(kicks))


def _lag_by_rows(a: Array, kicks: Array, begin: Array) -> Array:
    """The same by factors (n, ..., c) that differ: of many draws, rows are faster."""
    found, x = np.empty_like(kicks), begin
    for k, kick in enumerate(kicks):
        x = a[k] * x + kick
        found[k] = x
    return found


def variance_of_mean(ratio: Array) -> Array:
    """Variance of the mean over a time; `ratio` of the correlation time to it."""
    return np.asarray(2.0 * ratio * (1.0 - ratio * -np.expm1(-1.0 / ratio)))
