"""Predict the mean of the targets of the k nearest training points."""

from math import inf, nan, sqrt

from rovsim.dynamics.learned.layout import (
    COUNT,
    DISTANCE,
    HEADER,
    LANES,
    MAX_NEIGHBOURS,
    OUTPUTS,
    POINTS,
    UNROLL,
    WEIGHTING,
    WIDTH,
)
from rovsim.dynamics.learned.simd import exact, scaled
from rovsim.dynamics.learned.tree_search import Nearest, Query, Tree, search


@exact
def _weigh(near, k, weighting):
    """Replace the squared distances of the k nearest by weights, all 1 or inverse distances.

    With inverse distances, points at distance 0 have the weight 1 and all others 0.
    """
    hit = weighting == DISTANCE and near[0] == 0.0
    for p in range(k):
        if hit:
            near[p] = 1.0 if near[p] == 0.0 else 0.0
        else:
            near[p] = 1.0 / sqrt(near[p]) if weighting == DISTANCE else 1.0


@exact
def _average(targets, m, near, place, k, out):
    """Write the weighted mean of the targets (n m,) of the k nearest into out (m,)."""
    total = 0.0
    out[:m] = 0.0
    for p in range(k):
        total += near[p]
        at = int(place[p]) * m
        for o in range(m):
            out[o] += near[p] * targets[at + o]
    for o in range(m):
        out[o] /= total


@exact
def _turn(axes, z, turned):
    """Rotate z (d,) into the principal axes (d', d); the result goes to `turned` (d',)."""
    for i in range(axes.shape[0]):
        turned[i] = 0.0
        for j in range(axes.shape[1]):
            turned[i] += axes[i, j] * z[j]


@exact
def _squared_length(z):
    """Squared length of z (d,)."""
    total = 0.0
    for j in range(z.size):
        total += z[j] * z[j]
    return total


@exact
def neighbours(data, x, scratch, out):
    """Write the mean of the nearest targets at unscaled features x (d,) into out (m,)."""
    d, n, m, k = int(data[WIDTH]), int(data[POINTS]), int(data[OUTPUTS]), int(data[COUNT])
    wide, leaves = (d + UNROLL - 1) // UNROLL * UNROLL, (n + LANES - 1) // LANES
    nodes, below = 0, leaves
    while nodes == 0 or below > 1:
        below = (below + LANES - 1) // LANES
        nodes += below
    first = HEADER + 2 * d
    axes = data[first : first + wide * d].reshape((wide, d))
    first += wide * d
    last = first + nodes * 2 * wide * LANES
    boxes = data[first:last].reshape((nodes, 2, wide, LANES))
    first, last = last, last + leaves * wide * LANES
    points = data[first:last].reshape((leaves, wide, LANES))
    rows, last = data[last : last + leaves * LANES], last + leaves * LANES
    unrotated, targets = data[last : last + n * d].reshape((n, d)), data[last + n * d :]
    turned, near, row = scratch[:wide], scratch[LANES:], scratch[LANES + MAX_NEIGHBOURS :]
    place = scratch[LANES + 2 * MAX_NEIGHBOURS :]
    z = scratch[LANES + 3 * MAX_NEIGHBOURS :][:wide]
    rest = scratch[2 * LANES + 3 * MAX_NEIGHBOURS :]
    scaled(data, HEADER, d, x, z)
    _turn(axes, z, turned)
    query = Query(turned, z, _squared_length(z[:d]))
    search(Tree(boxes, points, unrotated, rows), query, Nearest(near, row, place, k), rest)
    if near[k - 1] == inf:  # x is not finite, or too far away to measure
        out[:m] = nan
        return
    _weigh(near, k, data[WEIGHTING])
    _average(targets, m, near, place, k, out)
