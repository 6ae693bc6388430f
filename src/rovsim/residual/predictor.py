"""A trained residual as one flat float64 array, and the kernels that evaluate it.

    header   FORMAT, KIND, BLOCKS, WIDTH d, POINTS n, OUTPUTS m, COUNT, WEIGHTING
    neighbours (COUNT = k):          part with targets (n, m)
    kernel expansion (COUNT = p):    mean (m), then p parts with weights (n', m / p)
    part     shift (d), scale (d), points (blocks, d, LANES), values; n' = blocks * LANES

Points stand scaled, feature by feature in blocks of LANES, so that the distances to a block are
computed side by side. The last block is filled up with zeros (and zero weights).
`rovsim.residual.export` writes such arrays and checks those that come from a file: the kernels
trust them. They are safe to call from many threads: scratch lies on the caller's stack.
"""

from math import exp, inf, nan, sqrt

import numpy as np
from llvmlite import ir
from numba import carray, njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from rovsim.residual.features import BLOCKS, FEATURES

FORMAT, KIND, _, WIDTH, POINTS, OUTPUTS, COUNT, WEIGHTING = range(8)
assert _ == BLOCKS  # `features` names that slot, because it may not import this module
HEADER = 8
VERSION = 1.0
NEIGHBOURS, EXPANSION = 0.0, 1.0
UNIFORM, DISTANCE = 0.0, 1.0

LANES = 32  # points a block: eight AVX2 registers of float64
MOST_NEIGHBOURS = 64  # bounds the scratch; more neighbours than this would only be an average
CHECK = 4  # features between two looks whether a block can be given up

_SCRATCH = FEATURES + LANES + 2 * MOST_NEIGHBOURS


@intrinsic
def _stack(typing):
    """Pointer to _SCRATCH float64 on the stack of the calling function: no heap, no sharing."""

    def codegen(context, builder, signature, arguments):
        return cgutils.alloca_once(builder, ir.DoubleType(), size=_SCRATCH)

    return types.CPointer(types.float64)(), codegen


@njit(cache=True)
def _scale(data, at, d, x, scaled):
    for j in range(d):
        scaled[j] = (x[j] - data[at + j]) / data[at + d + j]


@njit(cache=True)
def _squared_distances(points, b, x, limit, s):
    """Squared distances s (LANES,) of x to block b; False once all are known to reach `limit`."""
    for i in range(LANES):
        s[i] = 0.0
    for j in range(points.shape[1]):
        for i in range(LANES):
            e = points[b, j, i] - x[j]
            s[i] += e * e
        if j % CHECK == CHECK - 1:
            closer = 0
            for i in range(LANES):
                closer += s[i] < limit
            if closer == 0:
                return False
    return True


@njit(cache=True)
def _insert(near, rows, k, value, row):
    """Put a distance into the sorted list; at equal distance the earlier training row stays."""
    p = k - 1
    while p > 0 and near[p - 1] > value:
        near[p], rows[p] = near[p - 1], rows[p - 1]
        p -= 1
    near[p], rows[p] = value, row


@njit(cache=True)
def _search(points, n, k, x, s, near, rows):
    """Squared distances and row numbers of the k points nearest to x, nearest first."""
    for p in range(k):
        near[p] = inf
    for b in range(points.shape[0]):
        if _squared_distances(points, b, x, near[k - 1], s):
            first = b * LANES
            for i in range(min(LANES, n - first)):
                if s[i] < near[k - 1]:
                    _insert(near, rows, k, s[i], first + i)


@njit(cache=True)
def _weigh(near, k, weighting):
    """Turn squared distances into weights; a point that was hit exactly leaves only such points."""
    hit = weighting == DISTANCE and near[0] == 0.0
    for p in range(k):
        if hit:
            near[p] = 1.0 if near[p] == 0.0 else 0.0
        else:
            near[p] = 1.0 / sqrt(near[p]) if weighting == DISTANCE else 1.0


@njit(cache=True)
def _neighbours(data, x, scratch, out):
    d, n, m, k = int(data[WIDTH]), int(data[POINTS]), int(data[OUTPUTS]), int(data[COUNT])
    blocks = (n + LANES - 1) // LANES
    first = HEADER + 2 * d
    last = first + blocks * d * LANES
    points = data[first:last].reshape((blocks, d, LANES))
    scaled, s = scratch[:d], scratch[FEATURES : FEATURES + LANES]
    near = scratch[FEATURES + LANES : FEATURES + LANES + k]
    rows = scratch[FEATURES + LANES + MOST_NEIGHBOURS : FEATURES + LANES + MOST_NEIGHBOURS + k]
    _scale(data, HEADER, d, x, scaled)
    _search(points, n, k, scaled, s, near, rows)
    if near[k - 1] == inf:  # x is not finite, or too far away to measure
        out[:m] = nan
        return
    _weigh(near, k, data[WEIGHTING])
    total = 0.0
    for p in range(k):
        total += near[p]
    out[:m] = 0.0
    for p in range(k):
        row = last + int(rows[p]) * m
        for o in range(m):
            out[o] += near[p] * data[row + o]
    for o in range(m):
        out[o] /= total


@njit(cache=True)
def _add_part(points, weights, x, s, out):
    """Add sum_i weights[i] exp(-|x - point_i|^2) to out."""
    for b in range(points.shape[0]):
        _squared_distances(points, b, x, inf, s)
        for i in range(LANES):
            s[i] = exp(-s[i])
        for i in range(LANES):
            for o in range(weights.shape[1]):
                out[o] += weights[b * LANES + i, o] * s[i]


@njit(cache=True)
def _expansion(data, x, scratch, out):
    d, n, m, parts = int(data[WIDTH]), int(data[POINTS]), int(data[OUTPUTS]), int(data[COUNT])
    blocks, share = (n + LANES - 1) // LANES, m // parts
    scaled, s = scratch[:d], scratch[FEATURES : FEATURES + LANES]
    at = HEADER + m
    for o in range(m):
        out[o] = data[HEADER + o]
    for part in range(parts):
        _scale(data, at, d, x, scaled)
        first = at + 2 * d
        last = first + blocks * d * LANES
        at = last + blocks * LANES * share
        points = data[first:last].reshape((blocks, d, LANES))
        weights = data[last:at].reshape((blocks * LANES, share))
        _add_part(points, weights, scaled, s, out[part * share : (part + 1) * share])


@njit(cache=True)
def evaluate(data, x, out):
    """Residual body acceleration out (6,), m/s2 and rad/s2, at one sample's features x.

    x may be longer than the residual's features: the rest is not read. Not finite in, NaN out.
    """
    scratch = carray(_stack(), (_SCRATCH,))  # type: ignore[call-arg]
    if data[KIND] == NEIGHBOURS:
        _neighbours(data, x, scratch, out)
    else:
        _expansion(data, x, scratch, out)


@njit(cache=True)
def evaluate_many(data, X):
    """Residual body acceleration (n, 6) at features X (n, d), one row after the other."""
    out = np.empty((X.shape[0], int(data[OUTPUTS])))
    for row in range(X.shape[0]):
        evaluate(data, X[row], out[row])
    return out
