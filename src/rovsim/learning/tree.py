"""Build the packed tree of bounding boxes that `rovsim.dynamics.learned.tree_search` searches.

Points are split in two along the feature with the largest variance, so that the first part fills
whole subtrees (White & Jain 1996, the VAMSplit R-tree). Then all leaves but the last are full, and
no pointers are needed.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.learned.layout import LANES, UNROLL, filled, tree_levels


@dataclass(frozen=True, eq=False)
class Tree:
    """A packed tree of bounding boxes, with LANES children a node and LANES points a leaf.

    Attributes:
        order: indices (n,) of the points, leaf after leaf.
        boxes: (nodes, 2, d', LANES), lowest level first: lower and upper corners of the bounding
            boxes of each node's children. d' is the number of features, filled up (`layout`).
    """

    order: Array
    boxes: Array


def packed_tree(points: Array) -> Tree:
    """Build the tree of points (n, d)."""
    order = _ordered(points, np.arange(len(points)))
    starts = np.arange(0, len(points), LANES)
    lower = np.minimum.reduceat(points[order], starts)
    upper = np.maximum.reduceat(points[order], starts)
    levels = []
    for nodes, count in pairwise(tree_levels(len(points))):
        levels.append(np.stack([side_by_side(lower), side_by_side(upper)], axis=1))
        starts = np.arange(0, nodes, LANES)
        lower, upper = np.minimum.reduceat(lower, starts), np.maximum.reduceat(upper, starts)
        assert len(levels[-1]) == len(lower) == count
    return Tree(order, np.concatenate(levels))


def _ordered(points: Array, rows: Array) -> Array:
    """Order some row indices of points (n, d) so that each leaf's rows follow one another."""
    if len(rows) <= LANES:
        return rows
    subtree = LANES
    while subtree * LANES < len(rows):
        subtree *= LANES
    cut = max(-(-len(rows) // subtree) // 2, 1) * subtree
    widest = int(np.argmax(points[rows].var(axis=0)))
    split = rows[np.argpartition(points[rows, widest], cut - 1)]
    return np.concatenate([_ordered(points, split[:cut]), _ordered(points, split[cut:])])


def side_by_side(points: Array) -> Array:
    """Arrange points (n, d) as (blocks, d', LANES), filled up with zeros; see `layout`."""
    n, d = points.shape
    full = np.zeros((filled(n, LANES), filled(d, UNROLL)))
    full[:n, :d] = points
    return full.reshape(-1, LANES, full.shape[1]).transpose(0, 2, 1)
