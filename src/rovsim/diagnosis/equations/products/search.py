"""Which term comes next: sparse regression of what is left on the library, by PySINDy.

Forward regression with orthogonal least squares (FROLS: Billings 2013) of PySINDy. Why PySINDy: its
optimisers take any columns, here those that the observer's filters made of each term, so that the
regression is weighed with the disturbance's own covariance; it is deterministic and has no other
runtime. PySR downloads Julia when it is installed; gplearn breeds formulae from raw numbers, at
random, and knows neither dimensions nor coloured noise.
"""

import warnings
from collections import Counter

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import LawTerm

FIRST = 6  # the likeliest single terms
KEPT = 150  # columns of the regression: those that explain most alone
RIDGE = 1e-7  # of each column's own square


def propose(columns: Columns, steps: int) -> list[LawTerm]:
    """Terms worth a fit, the most often named first.

    Named by the likeliest `steps` terms together, on all blocks and without each of them, and by
    what each of the likeliest would explain alone.
    """
    whole = columns.gram
    subsets = [whole, *(whole - part for part in columns.parts)]
    named = Counter(k for G in subsets for k in _follow(G, steps))
    alone = find_alone(whole)
    order = sorted(named, key=lambda k: (-named[k], -alone[k]))
    order += [int(k) for k in np.argsort(-alone, kind="stable")[:FIRST] if k not in named]
    return [columns.terms[k] for k in order]


def find_alone(G: Array) -> Array:
    """What each term (c,) explains alone: decrease of the sum of squares."""
    power = np.diag(G)[1:]
    return np.divide(G[0, 1:] ** 2, power, out=np.zeros(len(power)), where=power > 0.0)


def _follow(G: Array, steps: int) -> list[int]:
    """The terms of PySINDy's forward regression, in order."""
    from pysindy import FROLS

    kept = np.sort(np.argsort(-find_alone(G), kind="stable")[:KEPT])
    H, b = G[1:, 1:][np.ix_(kept, kept)], G[1:, 0][kept]
    scale = np.sqrt(np.maximum(np.diag(H), 1e-300))
    X, y = _as_rows(H / np.outer(scale, scale), b / scale)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that columns resemble one another
        path = FROLS(max_iter=steps, alpha=1e-9, unbias=False).fit(X, y[:, None]).history_
    found: list[int] = []
    for row in path[: steps + 1]:  # the first has no term
        found += [int(kept[k]) for k in np.flatnonzero(row[0]) if kept[k] not in found]
    return found


def _as_rows(H: Array, b: Array) -> tuple[Array, Array]:
    """X (c, c) and y (c,) with X'X = H and X'y = b: as many rows as columns, not as readings."""
    values, vectors = np.linalg.eigh(H)
    root = np.sqrt(np.maximum(values, RIDGE * values[-1]))
    return root[:, None] * vectors.T, (vectors.T @ b) / root
