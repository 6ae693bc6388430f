"""The variance of a Gaussian process, cheap enough for a control loop, and exact within a bound.

To compute the variance, k' (K + s2)^-1 k is needed, which reads n^2 numbers: k are the kernel
values between the query and n training points, K is the kernel matrix of these points, and s2 the
noise variance, in units of the prior variance. In the eigenvectors v_j and eigenvalues l_j of K it
is

    |k|^2 / s2 - sum_j (v_j' k)^2 l_j / (s2 (l_j + s2)),

and k k' <= K for any query, so (v_j' k)^2 <= l_j: leaving out all eigenvalues up to l changes the
variance nowhere by more than l^2 / (s2 (l + s2)) of the prior's. An RBF kernel of 2,000 points in
12 features has a few hundred above that for a millionth: an eighth of the numbers.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy import ndarray as Array

# Of the prior variance: what the exported variance may differ from the process' own.
EXACT_TOLERANCE = 1e-6
# The same for fading, at a tenth of the cost; 1 - rho stays right within a quarter.
ROUGH_TOLERANCE = 5e-2


@dataclass(frozen=True, eq=False)
class PosteriorVariance:
    """Gives the share rho of the prior variance that remains at a query with kernel values k (n,).

    rho = 1 - identity |k|^2 - sum_j spectrum_j (vectors_j k)^2

    Attributes:
        identity: factor of |k|^2.
        spectrum: (r,) factors of the other terms, those that matter most first.
        vectors: (r, n) in the same order.
        fading_rank: how many of these terms are computed where only fading needs rho.
        limit: of rho, up to which the correction counts fully.
    """

    identity: float
    spectrum: Array
    vectors: Array
    fading_rank: int
    limit: float = 0.0

    def prior_share(self, k: Array, rank: int) -> Array:
        """Compute rho (q,) at q queries with kernel values k (q, n), from `rank` vectors."""
        reduction = (k @ self.vectors[:rank].T) ** 2 @ self.spectrum[:rank]
        return np.clip(1.0 - self.identity * (k**2).sum(1) - reduction, 0.0, 1.0)

    def faded_from(self, k: Array, share: float) -> "PosteriorVariance":
        """Set the limit so that the correction counts fully at this share of q queries k (q, n)."""
        limit = float(np.quantile(self.prior_share(k, self.fading_rank), share))
        return PosteriorVariance(
            self.identity, self.spectrum, self.vectors, self.fading_rank, limit
        )


def rbf(X: Array, Z: Array, lengthscale: Array) -> Array:
    """RBF kernel matrix (x, z) of scaled features X (x, d) and Z (z, d); 1 at distance 0."""
    squares = scipy.spatial.distance.cdist(X / lengthscale, Z / lengthscale, "sqeuclidean")
    return np.exp(-0.5 * squares)


def decompose_exact(values: Array, vectors: Array, noise: float) -> PosteriorVariance:
    """Make the variance of an exact Gaussian process from the eigenvectors of its kernel matrix.

    Args:
        values: eigenvalues (n,), in ascending order, of the kernel matrix with 1 on the diagonal.
        vectors: the eigenvectors (n, n), one a column.
        noise: variance of the noise, > 0, in units of the prior variance.
    """
    used = values > _least(noise, EXACT_TOLERANCE)
    used[-1] = True  # even with much noise: rank 0 would mean that there is no variance
    values, vectors = values[used][::-1], vectors[:, used][:, ::-1]
    spectrum = -values / (noise * (values + noise))
    fading_rank = int(np.sum(values > _least(noise, ROUGH_TOLERANCE)))
    return PosteriorVariance(
        1.0 / noise, spectrum, np.ascontiguousarray(vectors.T), max(fading_rank, 1)
    )


def _least(noise: float, bound: float) -> float:
    """The eigenvalue l with l^2 / (noise (l + noise)) = bound."""
    return 0.5 * noise * (bound + np.sqrt(bound * bound + 4.0 * bound))


def decompose_quadratic(A: Array) -> PosteriorVariance:
    """Make the variance of a process with rho = 1 - k' A k, for a symmetric A (n, n)."""
    values, vectors = scipy.linalg.eigh(0.5 * (A + A.T))
    order = np.argsort(-np.abs(values))
    return PosteriorVariance(
        0.0, values[order], np.ascontiguousarray(vectors[:, order].T), len(values)
    )
