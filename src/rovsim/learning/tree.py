"""A packed tree of bounding boxes, as `rovsim.dynamics.learned.neighbours` searches it.

Points are halved along their widest feature, at whole subtrees (White & Jain 1996, the VAMSplit
R-tree): all leaves but the last are full, and no pointers are needed.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.learned.layout import LANES, PASS, filled, tree_levels


@dataclass(frozen=True, eq=False)
class Tree:
    """`order` (n,) of the points in the leaves; `boxes` (nodes, 2, d', LANES), lowest level first.

    A node's two sheets are the lower and upper corners of its children's boxes.
    """

    order: Array
    boxes: Array


def packed_tree(points: Array) -> Tree:
    """The tree of points (n, d)."""
    order = _ordered(points, np.arange(len(points)))
    starts = np.arange(0, len(points), LANES)
    lower = np.minimum.reduceat(points[order], starts)
    upper = np.maximum.reduceat(points[order], starts)
    levels = []
    for below, count in pairwise(tree_levels(len(points))):
        levels.append(np.stack([side_by_side(lower), side_by_side(upper)], axis=1))
        starts = np.arange(0, below, LANES)
        lower, upper = np.minimum.reduceat(lower, starts), np.maximum.reduceat(upper, starts)
        assert len(levels[-1]) == len(lower) == count
    return Tree(order, np.concatenate(levels))


def _ordered(points: Array, rows: Array) -> Array:
    """Rows in the order of the leaves they belong to."""
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
    """Points (n, d) as (blocks, d', LANES), filled up with zeros. See `layout`."""
    n, d = points.shape
    full = np.zeros((filled(n, LANES), filled(d, PASS)))
    full[:n, :d] = points
    return full.reshape(-1, LANES, full.shape[1]).transpose(0, 2, 1)
