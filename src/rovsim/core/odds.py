"""Convert odds to likelihood-ratio statistics (twice the logarithm of odds to one) and back."""

from math import exp, log
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

MAX_STATISTIC = 1400.0  # beyond, odds are larger than any floating-point number


def lr_statistic_of(odds: float) -> float:
    """Twice the logarithm of odds to one, rounded to one decimal."""
    return round(2.0 * log(odds), 1)


def odds_of(lr_statistic: float) -> float:
    """Odds to one of an explanation against another, with this likelihood-ratio statistic."""
    return exp(0.5 * min(max(lr_statistic, -MAX_STATISTIC), MAX_STATISTIC))


def probability_of(lr_statistic: float) -> float:
    """Probability of an explanation with this likelihood-ratio statistic against the only other."""
    return 1.0 / (1.0 + odds_of(-lr_statistic))


def share_odds(lr_statistics: Sequence[float]) -> Array:
    """Probabilities (n,) of n explanations of which exactly one is true.

    Args:
        lr_statistics: likelihood-ratio statistic (n,) of each against a common reference; -inf for
            one that cannot be true.
    """
    log_odds = 0.5 * np.asarray(lr_statistics, dtype=float)
    weight = np.exp(log_odds - np.max(log_odds))
    return np.asarray(weight / weight.sum())
