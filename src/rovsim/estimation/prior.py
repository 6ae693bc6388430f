"""What is known of parameters before the runs are looked at."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array


@dataclass(frozen=True, eq=False)
class Prior:
    """Gaussians `about` some values (k,), scaled, with `std` (k,); infinite: nothing is known.

    `faulty` (k,): those that may also be far off, as what has a fault is: with tails of Cauchy.
    """

    about: Array
    std: Array
    faulty: Array

    @staticmethod
    def around(x: Array, std: float) -> "Prior":
        """The same spread about each of some values (k,)."""
        return Prior(x, np.full(len(x), std), np.zeros(len(x), bool))

    def cost(self, x: Array) -> float:
        """Minus twice the logarithm of its density at x (k,), but for a constant."""
        square = ((x - self.about) / self.std) ** 2
        return float(np.sum(np.where(self.faulty, cauchy(square), square)))

    def weights(self, x: Array) -> Array:
        """Half of the cost is that of springs so stiff (k,) at x (k,)."""
        square = ((x - self.about) / self.std) ** 2
        return np.where(self.faulty, 2.0 / (1.0 + square), 1.0) / self.std**2


def cauchy(square: Array) -> Array:
    """Minus twice the logarithm of Cauchy's density at squared distances in its scales."""
    return 2.0 * np.log1p(square)
