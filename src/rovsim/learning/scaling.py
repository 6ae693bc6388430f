"""Features brought to one size, with numbers taken from the training set alone."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

# A column that varies less than this (SI units) is constant: what varies in it is rounding, such
# as the heave force of a mixer whose vertical thrusters are off.
CONSTANT = 1e-9


@dataclass(frozen=True, eq=False)
class Scaling:
    """Scaled features are (X - shift) / scale; shift and scale (d,)."""

    shift: Array
    scale: Array

    def apply(self, X: Array) -> Array:
        """Scaled copy of X (n, d)."""
        return (X - self.shift) / self.scale


def fit_scaling(kind: str, X: Array) -> Scaling:
    """Scaling fitted on training rows X (n, d).

    `standard`: mean 0, standard deviation 1; `range`: 0 to 1; `none`: as they are. A constant
    column keeps its unit (scale 1).
    """
    d = X.shape[1]
    if kind == "none":
        return Scaling(np.zeros(d), np.ones(d))
    spread = np.ptp(X, axis=0)
    shift, scale = (X.mean(0), X.std(0)) if kind == "standard" else (X.min(0), spread)
    return Scaling(shift, np.where(spread > CONSTANT, scale, 1.0))
