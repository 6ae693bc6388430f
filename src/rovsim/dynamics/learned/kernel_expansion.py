"""A sum of RBF kernels around points: the mean of a Gaussian process, and its variance.

With k_i = exp(-|z - z_i|^2 / 2) at scaled features z, the mean is `mean` + weights k, and the
variance, as a share of the prior variance (Rasmussen & Williams 2006, eqs. 2.25 and 2.26),

    rho = 1 - identity |k|^2 - sum_j spectrum_j (v_j' k)^2

is 0 where the process is certain and 1 far from all training points; identity, spectrum and vectors
come from `rovsim.learning.posterior_variance`. The correction fades where it extrapolates: up to
rho = `limit` it counts fully, beyond that it is multiplied by (1 - rho) / (1 - limit).
"""

from typing import Any, NamedTuple

from numba import njit

from rovsim.dynamics.compilation.compiled import INTERNAL
from rovsim.dynamics.learned.layout import (
    COUNT,
    FADING_RANK,
    HEADER,
    LANES,
    OUTPUTS,
    POINTS,
    RANK,
    UNROLL,
    WIDTH,
)
from rovsim.dynamics.learned.simd import add_squares, exponentials, products, scaled

plain = njit(error_model="numpy", **INTERNAL)


class KernelArrays(NamedTuple):
    """Views of the arrays of one kernel of an expansion, see `layout`.

    Attributes:
        first: index of its first output.
        share: number of its outputs.
        identity: factor of |k|^2 in rho.
        limit: of rho, up to which the correction counts fully.
        prior: prior variance (share,) of each output.
        scaling: index in the exported array at which shift and scale of the features begin.
        points: scaled points (blocks, d', LANES).
        spectrum: (r',) factors of (v_j' k)^2 in rho.
        weights: flat (w', n'), of each output and point.
        vectors: flat (r', n'), the v_j.
    """

    first: int
    share: int
    identity: float
    limit: float
    prior: Any
    scaling: int
    points: Any
    spectrum: Any
    weights: Any
    vectors: Any


@plain
def _part(data, part):
    """Find the arrays of kernel number `part` in an exported residual."""
    d, n, m = int(data[WIDTH]), int(data[POINTS]), int(data[OUTPUTS])
    share, rank = m // int(data[COUNT]), (int(data[RANK]) + UNROLL - 1) // UNROLL * UNROLL
    wide, rows = (d + UNROLL - 1) // UNROLL * UNROLL, (share + UNROLL - 1) // UNROLL * UNROLL
    blocks = (n + LANES - 1) // LANES
    length = blocks * LANES
    size = 2 + share + 2 * d + length * wide + rank + (rows + rank) * length
    at = HEADER + m + part * size
    prior = at + 2
    scaling = prior + share
    points = scaling + 2 * d
    spectrum = points + length * wide
    weights = spectrum + rank
    vectors = weights + rows * length
    return KernelArrays(
        part * share,
        share,
        data[at],
        data[at + 1],
        data[prior:scaling],
        scaling,
        data[points:spectrum].reshape((blocks, wide, LANES)),
        data[spectrum:weights],
        data[weights:vectors],
        data[vectors : vectors + rank * length],
    )


@plain
def _kernel(data, part, x, scratch):
    """Compute the kernel values k (n',) between features x and the points of a part.

    The result is a view of `scratch`. Values of the points that fill up the last block are not 0,
    but their weights and vectors are.
    """
    blocks, wide = part.points.shape[0], part.points.shape[1]
    k, z = scratch[: blocks * LANES], scratch[blocks * LANES : blocks * LANES + wide]
    scaled(data, part.scaling, int(data[WIDTH]), x, z)
    for b in range(blocks):
        s = k[b * LANES : (b + 1) * LANES]
        s[:] = 0.0
        for j in range(0, wide, UNROLL):
            add_squares(part.points, b, j, z, s)
    exponentials(k)
    return k


@plain
def _mean(data, part, k, out):
    """Write the mean of the outputs of a part into out (m,), from its kernel values k (n',)."""
    for row in range(0, part.share, UNROLL):
        sums = products(part.weights, row, k)
        for o in range(min(UNROLL, part.share - row)):
            out[part.first + row + o] = data[HEADER + part.first + row + o] + sums[o]


@plain
def _variance_share(part, k, n, rank):
    """Compute rho from the kernel values k at n points and the first `rank` vectors."""
    explained = 0.0
    if part.identity != 0.0:
        for i in range(n):
            explained += k[i] * k[i]
    explained *= part.identity
    for row in range(0, rank, UNROLL):
        a, b, c, d = products(part.vectors, row, k)
        s = part.spectrum
        explained += (s[row] * a * a + s[row + 1] * b * b) + (
            s[row + 2] * c * c + s[row + 3] * d * d
        )
    return min(max(1.0 - explained, 0.0), 1.0) if explained == explained else explained


@plain
def faded(data, x, scratch, out):
    """Write the mean at features x into out (m,), faded if the residual has a FADING_RANK."""
    for number in range(int(data[COUNT])):
        part = _part(data, number)
        k = _kernel(data, part, x, scratch)
        _mean(data, part, k, out)
        if data[FADING_RANK] > 0.0:
            explained = 1.0 - _variance_share(part, k, int(data[POINTS]), int(data[FADING_RANK]))
            share = min(explained / max(1.0 - part.limit, 1e-300), 1.0)
            for o in range(part.first, part.first + part.share):
                out[o] *= share


@plain
def posterior(data, x, scratch, mean, variance):
    """Write mean (m,) and variance (m,) of the process at features x, without fading."""
    for number in range(int(data[COUNT])):
        part = _part(data, number)
        k = _kernel(data, part, x, scratch)
        _mean(data, part, k, mean)
        rho = _variance_share(part, k, int(data[POINTS]), int(data[RANK]))
        for o in range(part.share):
            variance[part.first + o] = part.prior[o] * rho
