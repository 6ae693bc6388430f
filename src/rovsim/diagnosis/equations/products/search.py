"""Propose the next term of a law by sparse regression of the innovations on all candidate terms.

The columns of the regression are the terms as the observer's filters respond to them, so it is
weighted by the covariance of the disturbance. It is deterministic, and needs Gram matrices alone.
"""

from collections import Counter

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import LawTerm
from rovsim.estimation.observer.least_squares import find_decreases, regress_forward

SINGLE_TERMS_PROPOSED = 6  # in any case: those that explain most alone
MAX_REGRESSION_COLUMNS = 150  # the terms that explain most alone


def propose(columns: Columns, steps: int) -> list[LawTerm]:
    """Propose terms that are worth a fit, the most promising first.

    The regression is repeated on all readings, and without each group of time blocks. Terms that
    more of these regressions select come first, then the terms that explain most alone.

    Args:
        columns: of the candidate terms.
        steps: how many terms each regression selects.
    """
    gram, decreases = columns.gram, columns.decreases
    subsets = [gram, *(gram - part for part in columns.parts)]
    counts = Counter(k for G in subsets for k in _select_forward(G, steps))
    order = sorted(counts, key=lambda k: (-counts[k], -decreases[k]))
    order += [
        int(k)
        for k in np.argsort(-decreases, kind="stable")[:SINGLE_TERMS_PROPOSED]
        if k not in counts
    ]
    return [columns.terms[k] for k in order]


def _select_forward(G: Array, steps: int) -> list[int]:
    """List the terms that forward regression selects, in the order of their selection.

    Args:
        G: Gram matrix (1 + c, 1 + c), see `Columns`.
        steps: how many terms to select, at most.

    Returns:
        Indices of the terms.
    """
    alone = find_decreases(G[1:, 1:], G[1:, 0])
    places = np.sort(np.argsort(-alone, kind="stable")[:MAX_REGRESSION_COLUMNS])
    H, b = G[1:, 1:][np.ix_(places, places)], G[1:, 0][places]
    return [int(places[k]) for k in regress_forward(H, b, steps).chosen]
