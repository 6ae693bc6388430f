"""How sure estimates are where the errors of some time or window go together.

Three estimates of one idea, the sandwich (White 1980) over clusters (Liang & Zeger 1986): the sums
of each cluster's scores tell how much it pulls, instead of the noise that was assumed. They differ
in what they are asked for, and in what they do where there are few clusters.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.observer.least_squares import as_rows, gram, solve


def estimate_covariance(rows: Array, cluster: Array) -> Array:
    """Covariance (k, k) of parameters at their least squares, of many clusters.

    Args:
        rows: whitened errors and their derivatives (1 + k, 6, n).
        cluster: number (n,) of the one that each reading lies in.
    """
    products = rows[1:] * rows[:1]
    scores = np.array([products[..., cluster == b].sum(axis=(1, 2)) for b in np.unique(cluster)])
    scores = scores - scores.mean(axis=0)
    inverse = solve(gram(as_rows(rows[1:])), np.eye(len(rows) - 1))
    return np.asarray(inverse @ (scores.T @ scores) @ inverse * len(scores) / (len(scores) - 1))


def estimate_covariance_of_few(e: Array, J: Array, cluster: Array) -> Array:
    """Covariance (k, k): how sure from the scores of each cluster, what goes together from J.

    There may be fewer clusters than parameters, which then would all seem to go together; and never
    surer than if every error were one for itself.

    Args:
        e: errors (6, n).
        J: their derivatives (k, 6, n).
        cluster: number (n,) of the one that each lies in.
    """
    bread = solve(gram(as_rows(J)), np.eye(len(J)))
    scores = np.einsum("kin,in->kn", J, e)
    influences = bread @ np.array([np.bincount(cluster, row) for row in scores])
    homoscedastic = np.diag(bread) * np.sum(e**2) / max(e.size - len(J), 1)
    ratio = np.sqrt(np.maximum(np.sum(influences**2, axis=1), homoscedastic) / np.diag(bread))
    return bread * np.outer(ratio, ratio)


def find_inflation(products: Array, power: float, cluster: Array) -> float:
    """How many times the variance of one factor is that where innovations are white, 1 at least.

    Args:
        products: of the column and what it leaves (n,).
        power: the square of the column: their variance where innovations are white.
        cluster: number (n,) of the one that each lies in.
    """
    sums = np.bincount(cluster, products)
    return max(1.0, float(sums @ sums) / power * len(sums) / max(1, len(sums) - 1))
