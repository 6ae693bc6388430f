"""Does an effect also help where it was not fitted? Blocks of the train runs take turns."""

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.evidence import Observatory
from rovsim.diagnosis.fit import Fit
from rovsim.diagnosis.gram import solved
from rovsim.diagnosis.watch import blocks

FOLDS = 6


def held_out_gain(found: Fit, observatory: Observatory, columns: list[int]) -> float:
    """Decrease of the squared innovations on held-out blocks by some of the free parameters.

    To first order around the fit: each fold's parameters are fitted to the other folds, with and
    without the columns; without means at the values that change nothing.
    """
    rows = np.concatenate(
        [observatory.white([e[None] for e in found.e], found.noise),
         observatory.white(found.J, found.noise)]
    )  # fmt: skip
    fold = blocks(observatory.watches) % FOLDS
    parts = [_products(rows[..., fold == k]) for k in np.unique(fold)]
    total = sum(parts)
    gone = found.hypothesis.absent[columns] - found.hypothesis.x[columns]
    return sum(
        _cost(part, _step(total - part, columns, gone)) - _cost(part, _step(total - part, [], gone))
        for part in parts
    )


def _products(rows: Array) -> Array:
    flat = rows.reshape(len(rows), -1)
    return flat @ flat.T


def _step(M: Array, fixed: list[int], values: Array) -> Array:
    """Best step (k,) of all parameters on these products, some held at given steps."""
    H, g, x = M[1:, 1:], M[1:, 0], np.zeros(len(M) - 1)
    free = [j for j in range(len(x)) if j not in fixed]
    if fixed:
        x[fixed] = values
        g = g + H[:, fixed] @ values
    x[free] = -solved(H[np.ix_(free, free)], g[free])
    return x


def _cost(M: Array, x: Array) -> float:
    return float(M[0, 0] + 2.0 * M[1:, 0] @ x + x @ M[1:, 1:] @ x)
