"""Find the k nearest points, exactly, at any size, in a tree of bounding boxes.

The tree has LANES children a node (`rovsim.learning.tree` builds it), so that the distances to all
boxes of a node, and to all points of a leaf, are computed side by side. The nearest box is opened
first; a box farther away than the k-th nearest point is not opened (Roussopoulos et al. 1995).

Features are correlated, so boxes along their principal axes are much smaller: tree and points are
rotated into these axes. Where a rotated point is near enough, rounding errors allowed for, its
distance is computed again from the features as given. So the rotation changes neither the order nor
the distances of neighbours.

Of d features, n points and LANES points a block, many of these functions have as arguments:
    x: the query (d',), scaled and rotated.
    s: squared distances (LANES,) that are computed side by side.
"""

from math import inf
from typing import NamedTuple

from numpy import ndarray as Array

from rovsim.dynamics.learned.layout import LANES, MAX_LEVELS, UNROLL
from rovsim.dynamics.learned.simd import add_squares, exact, exact_inline

# Of squared lengths: far above what turning 21 features rounds, far below a gap.
_ROUNDING_SHARE = 1e-12
_MAX_OPEN_BOXES = MAX_LEVELS * LANES  # that wait to be opened: at most all of one node a level


class Tree(NamedTuple):
    """Training points, scaled, and the boxes around them.

    Attributes:
        boxes: low and high ends (nodes, 2, d', LANES) of the boxes of each node's children.
        points: rotated points (blocks, d', LANES).
        unrotated: points (n, d) as given.
        rows: training row (n',) of each point.
    """

    boxes: Array
    points: Array
    unrotated: Array
    rows: Array


class Query(NamedTuple):
    """Where a mean is asked for, scaled.

    Attributes:
        x: rotated (d',).
        z: not rotated (d,).
        size: squared length, which bounds the rounding errors.
    """

    x: Array
    z: Array
    size: float


class Nearest(NamedTuple):
    """The k nearest points so far, nearest first.

    Attributes:
        near: their squared distances.
        row: their training rows.
        place: their indices.
        k: how many they are.
    """

    near: Array
    row: Array
    place: Array
    k: int


@exact
def _outside(lower, upper, x):
    """Signed distance of x to an interval; 0 inside."""
    return x - min(max(x, lower), upper)


@exact
def _box_distances(boxes, b, x, s):
    """Write the squared distances of x to the boxes of the children of node b into s."""
    for i in range(LANES):
        s[i] = 0.0
    for j in range(0, boxes.shape[2], UNROLL):
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
    for j in range(0, points.shape[1], UNROLL):
        add_squares(points, b, j, x, s)
        closer = False
        for i in range(LANES):
            closer |= s[i] <= limit
        if not closer:
            return False
    return True


@exact
def _insert(nearest, distance, new_row, index):
    """Insert a point into the sorted list of the k nearest, if it belongs there.

    At equal distance the earlier training row comes first. `new_row` is the training row of the
    point, `index` its index.
    """
    near, row, place, p = nearest.near, nearest.row, nearest.place, nearest.k - 1
    if distance == near[p] and new_row > row[p]:
        return
    while p > 0 and (near[p - 1] > distance or (near[p - 1] == distance and row[p - 1] > new_row)):
        near[p], row[p], place[p] = near[p - 1], row[p - 1], place[p - 1]
        p -= 1
    near[p], row[p], place[p] = distance, new_row, index


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
    return distance + _ROUNDING_SHARE * (distance + size)


@exact
def _measured(unrotated, index, z):
    """Squared distance of z to the point with this index, as given."""
    total = 0.0
    for j in range(unrotated.shape[1]):
        e = unrotated[index, j] - z[j]
        total += e * e
    return total


@exact_inline
def _look_into_leaf(tree, b, query, nearest, s):
    """Insert the points of leaf b that are near enough into the list of the k nearest."""
    points, unrotated, rows = tree.points, tree.unrotated, tree.rows
    near, last, z, size = nearest.near, nearest.k - 1, query.z, query.size
    first, n = b * LANES, unrotated.shape[0]
    if _within(points, b, query.x, _allowed(near[last], size), s):
        for i in range(LANES):
            if first + i < n and s[i] < inf and s[i] <= _allowed(near[last], size):
                distance = _measured(unrotated, first + i, z)
                if distance <= near[last]:
                    _insert(nearest, distance, rows[first + i], first + i)


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


@exact_inline
def search(tree, query, nearest, scratch):
    """Find the k points nearest to the query; fills the arrays of `nearest`."""
    boxes, x, near, last = tree.boxes, query.x, nearest.near, nearest.k - 1
    s, waiting, index = scratch[:LANES], scratch[LANES:], scratch[LANES + _MAX_OPEN_BOXES :]
    level, counts = scratch[LANES + 2 * _MAX_OPEN_BOXES :], scratch[LANES + 3 * _MAX_OPEN_BOXES :]
    offsets = counts[MAX_LEVELS + 2 :]
    near[: nearest.k] = inf
    nearest.row[: nearest.k] = inf
    level[0] = _levels(tree.unrotated.shape[0], counts, offsets)
    waiting[0], index[0], size = 0.0, 0.0, 1
    while size > 0:
        size -= 1
        limit = _allowed(near[last], query.size)
        if waiting[size] > limit:
            continue
        height, node = int(level[size]), int(index[size])
        if height == 0:
            _look_into_leaf(tree, node, query, nearest, s)
            continue
        _box_distances(boxes, int(offsets[height]) + node, x, s)
        previous_size, boxes_below = size, int(counts[height - 1])
        size = _open_node(s, node * LANES, boxes_below, limit, waiting, index, size)
        level[previous_size:size] = height - 1
