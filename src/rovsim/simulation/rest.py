"""Initial states at rest and level, for runs whose start was planned and not measured."""

import numpy as np
from numpy import ndarray as Array

# How exactly people put a vehicle where a flight is to begin.
PLACEMENT_STD_M, PLACEMENT_STD_RAD = 0.05, 0.05


def rest_state(place: Array, heading: Array | float) -> Array:
    """States (..., 13) at rest and level, at places (..., 3) m NED, with headings (...) rad."""
    half = 0.5 * np.asarray(heading)
    state = np.zeros((*half.shape, 13))
    state[..., :3] = place
    state[..., 3], state[..., 6] = np.cos(half), np.sin(half)
    return state
