"""Compare the errors of two models in the same windows: is one of them surely smaller?

Windows differ more from each other than models do, so differences are judged window by window.
"""

import numpy as np
from numpy import ndarray as Array
from scipy.stats import norm
from scipy.stats import t as student

WORSE_SHARE = 0.02  # of the error: a smaller difference may depend on the choice of windows
CERTAIN_STANDARD_ERRORS = 2.0  # over many windows
MIN_WINDOWS = 2  # from one alone nothing can be said of chance
LOST_SHARE = 1.0  # of the error: a larger difference cannot depend on the choice of windows


def find_better(one: Array, other: Array) -> bool | None:
    """Whether the first of two errors (w,) is surely smaller; None where neither is."""
    if find_sure_improvement(other, one) > 0.0:
        return True
    return False if find_sure_improvement(one, other) > 0.0 else None


def find_less_lost(one: Array, other: Array) -> bool | None:
    """As `find_better`, but a model that fails in a few windows only is the worse one, too.

    Such windows make the mean error large, while nothing is sure by their spread.
    """
    finite, other_finite = (bool(np.isfinite(error).all()) for error in (one, other))
    if not (finite and other_finite):
        return finite if finite != other_finite else None
    if surely_costs(other, one, WORSE_SHARE):
        return True
    return False if surely_costs(one, other, WORSE_SHARE) else None


def find_sure_improvement(error: Array, other: Array, tried: int = 1) -> float:
    """By which share `other` (w,) is surely smaller than `error` (w,); 0 where that is not sure.

    `tried`: if `other` is the best of several, how many: the best is smaller by chance as well.
    """
    if not np.isfinite(other).all():
        return 0.0
    if not np.isfinite(error).all():
        return np.inf
    share = 1.0 - ratio(other, error)
    if share <= WORSE_SHARE or len(error) < MIN_WINDOWS:
        return 0.0
    return share if _is_surely_less(other, error, _find_limit(len(error), tried)) else 0.0


def surely_costs(error: Array, usual: Array, least: float) -> bool:
    """Whether an error (w,) is surely larger than the usual one (w,), by more than `least`.

    An error that is more than twice as large always counts. It may come from a few windows in which
    a model fails; these make the mean large, while nothing is sure by their spread.
    """
    increase = ratio(error, usual) - 1.0
    return increase > LOST_SHARE or (increase > least and _is_surely_less(usual, error))


def ratio(error: Array, other: Array) -> float:
    """Ratio of the root mean of two squared errors (w,); infinite where a model diverged."""
    with np.errstate(invalid="ignore", over="ignore"):
        return float(np.sqrt(np.nan_to_num(np.mean(error) / np.mean(other), nan=np.inf)))


def _is_surely_less(one: Array, other: Array, certain: float = CERTAIN_STANDARD_ERRORS) -> bool:
    """Whether an error (w,) is less than another by `certain` standard errors of the difference."""
    difference = other - one
    return bool(np.mean(difference) > certain * np.std(difference) / np.sqrt(len(difference)))


def _find_limit(windows: int, tried: int) -> float:
    """Standard errors that the best of `tried` differences exceeds as rarely as one exceeds two.

    By Student's t, since the spread is that of few windows; `np.std` divides by their number.
    """
    chance = norm.sf(CERTAIN_STANDARD_ERRORS) / tried
    return float(student.isf(chance, windows - 1) * np.sqrt(windows / (windows - 1.0)))
