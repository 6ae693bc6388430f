"""Propose the next term of a law by sparse regression of the innovations on all candidate terms.

The regression is forward regression with orthogonal least squares (FROLS: Billings 2013), by
PySINDy. PySINDy's optimisers accept any columns. Here these are the terms as the observer's filters
respond to them, so the regression is weighted by the covariance of the disturbance. PySINDy is also
deterministic and needs no other runtime: PySR downloads Julia when it is installed, and gplearn
evolves formulae from raw numbers at random, with neither dimensions nor coloured noise.
"""

import warnings
from collections import Counter

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import LawTerm

SINGLE_TERMS_PROPOSED = 6  # in any case: those that explain most alone
MAX_REGRESSION_COLUMNS = 150  # the terms that explain most alone
MIN_EIGENVALUE_SHARE = 1e-7  # of the largest: smaller ones of the Gram matrix are raised to it


def propose(columns: Columns, steps: int) -> list[LawTerm]:
    """Propose terms that are worth a fit, the most promising first.

    The regression is repeated on all readings, and without each group of time blocks. Terms that
    more of these regressions select come first, then the terms that explain most alone.

    Args:
        columns: of the candidate terms.
        steps: how many terms each regression selects.
    """
    gram = columns.gram
    subsets = [gram, *(gram - part for part in columns.parts)]
    counts = Counter(k for G in subsets for k in _select_forward(G, steps))
    reductions = find_alone(gram)
    order = sorted(counts, key=lambda k: (-counts[k], -reductions[k]))
    order += [
        int(k)
        for k in np.argsort(-reductions, kind="stable")[:SINGLE_TERMS_PROPOSED]
        if k not in counts
    ]
    return [columns.terms[k] for k in order]


def find_alone(G: Array) -> Array:
    """Compute what each of c terms would explain as the only addition.

    Args:
        G: Gram matrix (1 + c, 1 + c) of the whitened innovations and the columns of the terms.

    Returns:
        Decrease (c,) of the sum of squared whitened innovations; 0 for a term without effect.
    """
    power = np.diag(G)[1:]
    return np.divide(G[0, 1:] ** 2, power, out=np.zeros(len(power)), where=power > 0.0)


def _select_forward(G: Array, steps: int) -> list[int]:
    """List the terms that forward regression selects, in the order of their selection.

    Args:
        G: Gram matrix (1 + c, 1 + c), see `Columns`.
        steps: how many terms to select.

    Returns:
        Indices of the terms.
    """
    from pysindy import FROLS

    places = np.sort(np.argsort(-find_alone(G), kind="stable")[:MAX_REGRESSION_COLUMNS])
    H, b = G[1:, 1:][np.ix_(places, places)], G[1:, 0][places]
    scale = np.sqrt(np.maximum(np.diag(H), 1e-300))
    X, y = _as_rows(H / np.outer(scale, scale), b / scale)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # PySINDy warns of columns that resemble one another
        path = FROLS(max_iter=steps, alpha=1e-9, unbias=False).fit(X, y[:, None]).history_
    order: list[int] = []
    for row in path[: steps + 1]:  # the first row is that of no term
        order += [int(places[k]) for k in np.flatnonzero(row[0]) if places[k] not in order]
    return order


def _as_rows(H: Array, b: Array) -> tuple[Array, Array]:
    """Convert normal equations into the least squares problem that an optimiser expects.

    Args:
        H: Gram matrix (c, c) of the columns.
        b: product (c,) of the columns and the target.

    Returns:
        X (c, c) and y (c,) with X'X = H and X'y = b, which have as many rows as there are columns
        instead of one row for each reading.
    """
    values, vectors = np.linalg.eigh(H)
    root = np.sqrt(np.maximum(values, MIN_EIGENVALUE_SHARE * values[-1]))
    return root[:, None] * vectors.T, (vectors.T @ b) / root
