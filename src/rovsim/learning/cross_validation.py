"""Judged on stretches of the training runs that were left out, not on rows beside those seen.

Rows that follow one another share a disturbance. A marginal likelihood takes each for independent,
and what they share for a function of the features.
"""

from typing import Iterator

import numpy as np
from numpy import ndarray as Array

PARTS = 10  # each left out once
FACTORS = (1.0, 3.0, 10.0, 30.0, 100.0, 300.0)  # on the noise


def split_rows(rows: int) -> Iterator[Array]:
    """Indices of each of `PARTS` stretches of rows in the order of time; none is empty."""
    yield from (s for s in np.array_split(np.arange(rows), PARTS) if len(s))


def noise_factor(
    values: Array, vectors: Array, error: Array, outputscale: float, noise: float
) -> float:
    """By which of `FACTORS` to raise a process' noise so that it foresees left-out stretches best.

    Without stretch B the process misses its rows by [S^-1]_BB^-1 [S^-1 y]_B, S = outputscale K +
    noise I (Sundararajan & Keerthi 2001, of more than one row).

    Args:
        values: eigenvalues (n,) of the kernel matrix K, which has 1 on its diagonal.
        vectors: the eigenvectors (n, n), one a column; rows in the order of time.
        error: targets minus the mean (m, n).
        outputscale: prior variance.
        noise: variance that was tuned.
    """
    seen = vectors.T @ error.T
    missed = np.zeros(len(FACTORS))
    for i, factor in enumerate(FACTORS):
        inverse = 1.0 / (outputscale * np.maximum(values, 0.0) + factor * noise)
        weights = vectors @ (inverse[:, None] * seen)
        for out in split_rows(len(values)):
            own = (vectors[out] * inverse) @ vectors[out].T
            missed[i] += np.sum(np.linalg.solve(own, weights[out]) ** 2)
    return FACTORS[int(np.argmin(missed))]
