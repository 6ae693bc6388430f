"""First-order Gauss-Markov noise of unit variance: correlation falls off as exp(-t / T).

    x(t + h) = a x(t) + sqrt(1 - a^2) w,   a = exp(-h / T),   w ~ N(0, 1)

is exact at the instants, however long the step (Gillespie 1996, Phys. Rev. E 54, 2084: the
Ornstein-Uhlenbeck process). Steps are counted in correlation times T; callers scale.
"""

from itertools import accumulate

import numpy as np
from numpy import ndarray as Array


def decay(step: Array | float) -> Array:
    """Factor a of steps in correlation times."""
    return np.asarray(np.exp(-step))


def propagate(a: Array, normal: Array, begin: Array) -> Array:
    """Propagate the noise over n steps; return its values (n, ..., c) after each step.

    Args:
        a: decay factor of a step: one number or (c,); (n, ..., c) if the steps differ.
        normal: standard normal numbers (n, ..., c); if they are scaled, so are the values.
        begin: values (..., c) before the first step.
    """
    kicks = normal * np.sqrt(1.0 - a * a)
    return lag(a, kicks, begin) if a.ndim < 2 else _lag_by_rows(a, kicks, begin)


def draw(steps: int, step: float, random: np.random.Generator) -> Array:
    """Draw six channels (steps, 6) of stationary noise of unit variance.

    Args:
        steps: number of steps.
        step: length of a step in correlation times.
        random: source of random numbers.
    """
    normal = random.normal(size=(steps, 6))
    return propagate(decay(step), normal, random.normal(size=6))


def lag(a: Array, kicks: Array, begin: Array) -> Array:
    """Compute x = a x + kick (n, c) for successive kicks, as a first-order lag does.

    Args:
        a: factor, one number or (c,).
        kicks: inputs (n, c).
        begin: x (c,) before the first kick.
    """
    columns = zip(np.broadcast_to(a, begin.shape), begin, kicks.T, strict=True)
    return np.stack([_lag_column(float(a), float(first), k) for a, first, k in columns], axis=1)


def _lag_column(a: float, begin: float, kicks: Array) -> Array:
    # Python's floats are faster than rows of NumPy, and SciPy's filter takes a second to import.
    column = accumulate(kicks.tolist(), lambda x, kick: a * x + kick, initial=begin)
    next(column)
    return np.fromiter(column, float, len(kicks))


def _lag_by_rows(a: Array, kicks: Array, begin: Array) -> Array:
    """Compute `lag` with factors (n, ..., c) that differ; for many draws, rows are faster."""
    values, x = np.empty_like(kicks), begin
    for k, kick in enumerate(kicks):
        x = a[k] * x + kick
        values[k] = x
    return values


def variance_of_mean(ratio: Array) -> Array:
    """Variance of the mean of the noise over a time.

    Args:
        ratio: correlation time over that time, of any shape.
    """
    return np.asarray(2.0 * ratio * (1.0 - ratio * -np.expm1(-1.0 / ratio)))
