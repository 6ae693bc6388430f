"""Odds, as likelihood-ratio statistics (twice the logarithm of odds to one) and back."""

from math import exp, log
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

MOST = 1400.0  # of a statistic: beyond, odds are no number any more


def lr_statistic_of(odds: float) -> float:
    """Twice the logarithm of odds to one, to one digit."""
    return round(2.0 * log(odds), 1)


def odds_of(lr_statistic: float) -> float:
    """Odds to one of what is likelier by that than something else."""
    return exp(0.5 * min(max(lr_statistic, -MOST), MOST))


def probability_of(lr_statistic: float) -> float:
    """Probability of what is likelier by that than the one thing else that it may be."""
    return 1.0 / (1.0 + odds_of(-lr_statistic))


def share_odds(lr_statistics: Sequence[float]) -> Array:
    """Probabilities (n,) of explanations of which one holds; -inf: it cannot."""
    log_odds = 0.5 * np.asarray(lr_statistics, dtype=float)
    weight = np.exp(log_odds - np.max(log_odds))
    return np.asarray(weight / weight.sum())
