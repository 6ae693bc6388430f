"""The k nearest points, exactly, at any size: a search through a tree of bounding boxes.

The tree has LANES children a node (`rovsim.learning.tree` builds it), so that the distances to all
boxes of a node, and to all points of a leaf, are computed side by side. The nearest box is opened
first; a box farther away than the k-th nearest point is not opened (Roussopoulos et al. 1995).

Features are correlated, so boxes along their principal axes are much smaller: tree and points are
rotated into these axes. Where a rotated point is near enough, rounding errors allowed for, its
distance is computed again from the features as given. So the rotation changes neither the order nor
the distances of neighbours.

Arguments that many of these functions have (d features, n points, LANES points a block):
    points: rotated points (blocks, d', LANES).
    given: points (n, d) as given, scaled but not rotated.
    rows: training row (n',) of each point.
    x, z: the query, scaled: rotated (d',), and not rotated (d,).
    near, row, place: squared distance, training row and index of the k nearest points so far,
        nearest first.
    s: squared distances (LANES,) that are computed side by side.
"""

from math import inf, nan, sqrt

from rovsim.dynamics.learned.layout import (
    COUNT,
    DISTANCE,
    HEADER,
    LANES,
    MOST_LEVELS,
    MOST_NEIGHBOURS,
    OUTPUTS,
    PASS,
    POINTS,
    WEIGHTING,
    WIDTH,
)
from rovsim.dynamics.learned.simd import add_squares, exact, scaled

_ROUNDING = 1e-12  # of squared lengths: far above what turning 21 features rounds, far below a gap
_OPEN = MOST_LEVELS * LANES  # boxes that wait to be opened: at most all of one node a level


@exact
def _outside(lower, upper, x):
    """Signed distance of x to an interval; 0 inside."""
    return x - min(max(x, lower), upper)


@exact
def _box_distances(boxes, b, x, s):
    """Write the squared distances of x to the boxes of the children of node b into s."""
    for i in range(LANES):
        s[i] = 0.0
    for j in range(0, boxes.shape[2], PASS):
        x0, x1, x2, x3 = x[j], x[j + 1], x[j + 2], x[j + 3]
        for i in range(LANES):
            e0 = _outside(boxes[b, 0, j, i], boxes[b, 1, j, i], x0)
            e1 = _outside(boxes[b, 0, j + 1, i], boxes[b, 1, j + 1, i], x1)
            e2 = _outside(boxes[b, 0, j + 2, i], boxes[b, 1, j + 2, i], x2)
            e3 = _outside(boxes[b, 0, j + 3, i], boxes[b, 1, j + 3, i], x3)
            s[i] = (((s[i] + e0 * e0) + e1 * e1) + e2 * e2) + e3 * e3


@exact
def _within(points, b, x, limit, s):
    """Write the squared distances of x to the points of block b into s.

    Returns:
        False as soon as all of them exceed `limit`; s is then incomplete.
    """
    for i in range(LANES):
        s[i] = 0.0
    for j in range(0, points.shape[1], PASS):
        add_squares(points, b, j, x, s)
        closer = False
        for i in range(LANES):
            closer |= s[i] <= limit
        if not closer:
            return False
    return True


@exact
def _insert(near, row, place, k, distance, own, at):
    """Insert a point into the sorted list of the k nearest, if it belongs there.

    At equal distance the earlier training row comes first. `own` is the training row of the point,
    `at` its index.
    """
    p = k - 1
    if distance == near[p] and own > row[p]:
        return
    while p > 0 and (near[p - 1] > distance or (near[p - 1] == distance and row[p - 1] > own)):
        near[p], row[p], place[p] = near[p - 1], row[p - 1], place[p - 1]
        p -= 1
    near[p], row[p], place[p] = distance, own, at


@exact
def _open_node(s, child, last, limit, waiting, index, size):
    """Push the children of a node onto the stack of waiting boxes, the nearest on top.

    Args:
        s: squared distances (LANES,) of their boxes.
        child: index of the first child on its level.
        last: number of boxes on that level.
        limit: squared distance beyond which a box is left out.
        waiting: squared distances of the boxes on the stack.
        index: their indices on their levels.
        size: of the stack.

    Returns:
        The new size of the stack.
    """
    first = size
    for i in range(LANES):
        if s[i] <= limit and child + i < last:
            p = size
            while p > first and waiting[p - 1] < s[i]:
                waiting[p], index[p] = waiting[p - 1], index[p - 1]
                p -= 1
            waiting[p], index[p] = s[i], child + i
            size += 1
    return size


@exact
def _allowed(distance, size):
    """Squared distance in rotated axes that a point may have whose true one is `distance`.

    `size` is the squared length of the query, which bounds the rounding errors.
    """
    return distance + _ROUNDING * (distance + size)


@exact
def _measured(given, at, z):
    """Squared distance of z to the point with index `at`, as given."""
    total = 0.0
    for j in range(given.shape[1]):
        e = given[at, j] - z[j]
        total += e * e
    return total


@exact
def _look_into_leaf(points, given, rows, b, n, x, z, size, s, near, row, place, k):
    """Insert the points of leaf b that are near enough into the list of the k nearest."""
    first = b * LANES
    if _within(points, b, x, _allowed(near[k - 1], size), s):
        for i in range(LANES):
            if first + i < n and s[i] < inf and s[i] <= _allowed(near[k - 1], size):
                distance = _measured(given, first + i, z)
                if distance <= near[k - 1]:
                    _insert(near, row, place, k, distance, rows[first + i], first + i)


@exact
def _levels(n, counts, offsets):
    """Write the number of blocks of each level, and the index of its first node, into arrays.

    Returns:
        The level of the root; leaves are level 0. See `layout.tree_levels`.
    """
    counts[0], offsets[0], top, total = (n + LANES - 1) // LANES, 0.0, 0, 0.0
    while top == 0 or counts[top] > 1:
        top += 1
        counts[top], offsets[top] = (counts[top - 1] + LANES - 1) // LANES, total
        total += counts[top]
    return top


@exact
def _search(boxes, points, given, rows, n, x, z, scratch, near, row, place, k):
    """Find the k points nearest to the query; fills `near`, `row` and `place`."""
    size_of_query = 0.0
    for j in range(given.shape[1]):
        size_of_query += z[j] * z[j]
    s, waiting, index = scratch[:LANES], scratch[LANES:], scratch[LANES + _OPEN :]
    level, counts = scratch[LANES + 2 * _OPEN :], scratch[LANES + 3 * _OPEN :]
    offsets = counts[MOST_LEVELS + 2 :]
    near[:k] = inf
    row[:k] = inf
    level[0] = _levels(n, counts, offsets)
    waiting[0], index[0], size = 0.0, 0.0, 1
    while size > 0:
        size -= 1
        limit = _allowed(near[k - 1], size_of_query)
        if waiting[size] > limit:
            continue
        high, own = int(level[size]), int(index[size])
        if high == 0:
            _look_into_leaf(
                points, given, rows, own, n, x, z, size_of_query, s, near, row, place, k
            )
            continue
        _box_distances(boxes, int(offsets[high]) + own, x, s)
        before, last = size, int(counts[high - 1])
        size = _open_node(s, own * LANES, last, limit, waiting, index, size)
        level[before:size] = high - 1


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
def neighbours(data, x, scratch, out):
    """Write the mean of the nearest targets at unscaled features x (d,) into out (m,)."""
    d, n, m, k = int(data[WIDTH]), int(data[POINTS]), int(data[OUTPUTS]), int(data[COUNT])
    wide, leaves = (d + PASS - 1) // PASS * PASS, (n + LANES - 1) // LANES
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
    given, targets = data[last : last + n * d].reshape((n, d)), data[last + n * d :]
    turned, near, row = scratch[:wide], scratch[LANES:], scratch[LANES + MOST_NEIGHBOURS :]
    place = scratch[LANES + 2 * MOST_NEIGHBOURS :]
    z = scratch[LANES + 3 * MOST_NEIGHBOURS :][:wide]
    rest = scratch[2 * LANES + 3 * MOST_NEIGHBOURS :]
    scaled(data, HEADER, d, x, z)
    _turn(axes, z, turned)
    _search(boxes, points, given, rows, n, turned, z, rest, near, row, place, k)
    if near[k - 1] == inf:  # x is not finite, or too far away to measure
        out[:m] = nan
        return
    _weigh(near, k, data[WEIGHTING])
    _average(targets, m, near, place, k, out)
