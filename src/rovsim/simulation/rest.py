"""Where runs begin that nobody measured: at rest and level."""

import numpy as np
from numpy import ndarray as Array


def rest_state(place: Array, heading: Array | float) -> Array:
    """States (..., 13) at a place (..., 3) m NED, of headings (...) rad."""
    half = 0.5 * np.asarray(heading)
    state = np.zeros((*half.shape, 13))
    state[..., :3] = place
    state[..., 3], state[..., 6] = np.cos(half), np.sin(half)
    return state
