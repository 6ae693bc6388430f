"""Odds, as likelihood-ratio statistics and back."""

from math import log

import numpy as np


def lr_statistic_of(odds: float) -> float:
    """Twice the logarithm of odds to one, to one digit."""
    return round(2.0 * log(odds), 1)


def probability_of(lr_statistic: float) -> float:
    """Probability of what is likelier by that than the one thing else that it may be."""
    return float(1.0 / (1.0 + np.exp(-0.5 * min(lr_statistic, 700.0))))
