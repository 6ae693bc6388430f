"""Cross-validation on whole stretches of the training runs, not on single rows.

Rows that follow one another share a disturbance. A marginal likelihood takes their errors for
independent, and so takes the shared disturbance for a function of the features.
"""

from typing import Iterator

import numpy as np
from numpy import ndarray as Array

FOLDS = 10  # each left out once
NOISE_FACTORS = (1.0, 3.0, 10.0, 30.0, 100.0, 300.0)  # on the noise


def split_rows(rows: int) -> Iterator[Array]:
    """Yield the row indices of each of `FOLDS` stretches of consecutive rows; none is empty."""
    yield from (s for s in np.array_split(np.arange(rows), FOLDS) if len(s))


def noise_factor(
    values: Array, vectors: Array, error: Array, outputscale: float, noise: float
) -> float:
    """Choose the factor on a process' noise with which it predicts left-out stretches best.

    Trained without stretch B, the process predicts the rows of B with the error
    [S^-1]_BB^-1 [S^-1 y]_B, where S = outputscale K + noise I (Sundararajan & Keerthi 2001,
    generalised to more than one row).

    Args:
        values: eigenvalues (n,) of the kernel matrix K, which has 1 on its diagonal.
        vectors: the eigenvectors (n, n), one a column; rows in the order of time.
        error: targets minus the mean (m, n), of m outputs with this kernel.
        outputscale: prior variance.
        noise: variance of the noise that maximises the marginal likelihood.

    Returns:
        One of `NOISE_FACTORS`.
    """
    projected = vectors.T @ error.T
    losses = np.zeros(len(NOISE_FACTORS))
    for i, factor in enumerate(NOISE_FACTORS):
        inverse = 1.0 / (outputscale * np.maximum(values, 0.0) + factor * noise)
        weights = vectors @ (inverse[:, None] * projected)
        for out in split_rows(len(values)):
            block = (vectors[out] * inverse) @ vectors[out].T
            losses[i] += np.sum(np.linalg.solve(block, weights[out]) ** 2)
    return NOISE_FACTORS[int(np.argmin(losses))]
