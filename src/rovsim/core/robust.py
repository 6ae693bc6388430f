"""Statistics that a few wrong values do not change."""

import numpy as np
from numpy import ndarray as Array

STD_PER_MAD = 1.4826  # standard deviation over the median absolute deviation
LONG_STEP = 1.5  # usual steps: a longer one is a gap, as a missing value makes it twice as long


def robust_std(x: Array) -> float:
    """Standard deviation of values about zero, from the median of their sizes."""
    return float(STD_PER_MAD * np.median(np.abs(x)))


def usual_range(values: Array) -> tuple[Array, Array]:
    """Least and greatest along the first axis, without NaN and the outer 1 % at either end."""
    low, high = np.nanpercentile(values, [1.0, 99.0], axis=0)
    return low, high
