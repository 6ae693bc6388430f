"""Where a threshold lies: tried, for derivatives do not lead there.

What is just below a threshold acts at other moments than what is just above it, so that a small
step tells nothing of a larger one: a fit moves by single lines of the log, and stops.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

ABOUT = np.arange(-2.0, 2.5, 0.5)  # resolutions from the best of those that are tried


def place_thresholds(workspace: SearchWorkspace, h: Hypothesis, term: Term) -> Hypothesis:
    """A hypothesis with the thresholds of one of its terms where they explain most.

    Each value of its grid is tried, then what is about the best. All else stays as it is.
    """
    each = zip(h.terms, h.columns, strict=True)
    own = [
        (p, k)
        for one, at in each
        if one.id == term.id
        for p, k in zip(one.parameters, at, strict=True)
    ]
    for parameter, column in own:
        if parameter.tried:
            h = _choose(workspace, h, column, np.array(parameter.tried) / parameter.scale)
            about = ABOUT * parameter.resolution / parameter.scale
            h = _choose(workspace, h, column, h.x[column] + about)
    return h


def _choose(workspace: SearchWorkspace, h: Hypothesis, column: int, values: Array) -> Hypothesis:
    """The hypothesis with the value of a parameter that leaves least, perhaps its own."""
    tried = [h]
    for value in values:
        x = h.x
        x[column] = value
        tried.append(h.at(x))
    e = workspace.bank.evaluate([one.model for one in tried])
    squares = np.sum(workspace.bank.whiten(e, workspace.noise) ** 2, axis=(1, 2))
    return tried[int(np.argmin(np.nan_to_num(squares, nan=np.inf)))]
