"""Scale features by shifts and scales that are fitted on the training set alone."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

# A column that varies less than this (SI units) is constant: what varies in it is rounding, such
# as the heave force of a mixer whose vertical thrusters are off.
MIN_SPREAD = 1e-9


@dataclass(frozen=True, eq=False)
class Scaling:
    """Scales features to (X - shift) / scale; shift and scale are (d,)."""

    shift: Array
    scale: Array

    def apply(self, X: Array) -> Array:
        """Return scaled features (n, d) of unscaled ones X (n, d)."""
        return (X - self.shift) / self.scale


def fit_scaling(kind: str, X: Array) -> Scaling:
    """Fit a scaling on training rows.

    Args:
        kind: `standard` for mean 0 and standard deviation 1, `range` for 0 to 1, or `none`.
        X: unscaled features (n, d). A constant column gets the scale 1.
    """
    d = X.shape[1]
    if kind == "none":
        return Scaling(np.zeros(d), np.ones(d))
    spread = np.ptp(X, axis=0)
    shift, scale = (X.mean(0), X.std(0)) if kind == "standard" else (X.min(0), spread)
    return Scaling(shift, np.where(spread > MIN_SPREAD, scale, 1.0))
