"""How sure a Gaussian process is, cheap enough for a control loop and exact within a stated bound.

The variance needs k' (K + s2)^-1 k: n^2 numbers to read. In the eigenvectors v_j of K this is

    |k|^2 / s2 - sum_j (v_j' k)^2 l_j / (s2 (l_j + s2)),

and k k' <= K for any query, so (v_j' k)^2 <= l_j: leaving out all eigenvalues up to l changes the
variance nowhere by more than l^2 / (s2 (l + s2)) of the prior's. An RBF kernel of 2,000 points in
12 features has a few hundred above that for a millionth: an eighth of the numbers.
"""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array
from scipy.linalg import eigh
from scipy.spatial.distance import cdist

EXACT = 1e-6  # of the prior variance: what the exported variance may differ from the process' own
ROUGH = 5e-2  # the same for fading, at a tenth of the cost; known stays right within a quarter


@dataclass(frozen=True, eq=False)
class Known:
    """What a process knows at a query with kernel values k (n,): its share of the prior variance is

    rho = 1 - identity |k|^2 - sum_j spectrum_j (vectors_j k)^2.

    `spectrum` (r,), `vectors` (r, n), the weightiest first; fading uses the first `sure` of them,
    and counts a correction fully where rho is at most `limit`.
    """

    identity: float
    spectrum: Array
    vectors: Array
    sure: int
    limit: float = 0.0

    def unsure(self, k: Array, rank: int) -> Array:
        """rho (q,) at kernel values k (q, n), from the first `rank` vectors."""
        seen = (k @ self.vectors[:rank].T) ** 2 @ self.spectrum[:rank]
        return np.clip(1.0 - self.identity * (k**2).sum(1) - seen, 0.0, 1.0)

    def fully_at(self, k: Array, share: float) -> "Known":
        """The same with the limit that leaves this share of the queries as they are."""
        limit = float(np.quantile(self.unsure(k, self.sure), share))
        return Known(self.identity, self.spectrum, self.vectors, self.sure, limit)


def rbf(X: Array, Z: Array, lengthscale: Array) -> Array:
    """Kernel matrix (x, z) of scaled features, with the value 1 at distance 0."""
    return np.exp(-0.5 * cdist(X / lengthscale, Z / lengthscale, "sqeuclidean"))


def of_exact(values: Array, vectors: Array, noise: float) -> Known:
    """An exact process with noise variance > 0.

    Args:
        values: eigenvalues (n,), in ascending order, of its kernel matrix with 1 on the diagonal.
        vectors: the eigenvectors (n, n), one a column.
        noise: in units of the prior variance.
    """
    kept = values > _least(noise, EXACT)
    values, vectors = values[kept][::-1], vectors[:, kept][:, ::-1]
    spectrum = -values / (noise * (values + noise))
    sure = int(np.sum(values > _least(noise, ROUGH)))
    return Known(1.0 / noise, spectrum, np.ascontiguousarray(vectors.T), max(sure, 1))


def _least(noise: float, bound: float) -> float:
    """The eigenvalue l with l^2 / (noise (l + noise)) = bound."""
    return 0.5 * noise * (bound + np.sqrt(bound * bound + 4.0 * bound))


def of_quadratic(A: Array) -> Known:
    """A process with rho = 1 - k' A k, for a symmetric A (n, n)."""
    values, vectors = eigh(0.5 * (A + A.T))
    order = np.argsort(-np.abs(values))
    return Known(0.0, values[order], np.ascontiguousarray(vectors[:, order].T), len(values))
