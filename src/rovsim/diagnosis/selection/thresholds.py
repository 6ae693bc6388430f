"""Find the value of a threshold by trying values, since derivatives do not lead there.

A slightly larger threshold excludes just a few lines of the command log. So the effect of a small
step says nothing about a larger one, and a fit stops after a few lines.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

NEARBY_STEPS = np.arange(-2.0, 2.5, 0.5)  # in resolutions: values about the best of the grid


def add_term(workspace: SearchWorkspace, h: Hypothesis, term: Term) -> Hypothesis:
    """Add a term to a hypothesis, with its thresholds at the values that explain most there."""
    return place_thresholds(workspace, h.with_term(term), term)


def place_thresholds(workspace: SearchWorkspace, h: Hypothesis, term: Term) -> Hypothesis:
    """Set the thresholds of one term of a hypothesis to the values that explain most.

    The values of a grid are tried, then values about the best one. All other parameters stay.
    """
    pairs = zip(h.terms, h.columns, strict=True)
    parameters = [
        (p, k)
        for t, columns in pairs
        if t.id == term.id
        for p, k in zip(t.parameters, columns, strict=True)
    ]
    for parameter, column in parameters:
        if parameter.tried:
            h = _choose_value(workspace, h, column, np.array(parameter.tried) / parameter.scale)
            nearby = NEARBY_STEPS * parameter.resolution / parameter.scale
            h = _choose_value(workspace, h, column, h.x[column] + nearby)
    return h


def _choose_value(
    workspace: SearchWorkspace, h: Hypothesis, column: int, values: Array
) -> Hypothesis:
    """The hypothesis with the best of some scaled values of one parameter, its own among them."""
    trials = [h]
    for value in values:
        x = h.x
        x[column] = value
        trials.append(h.at(x))
    e = workspace.bank.evaluate([t.model for t in trials])
    squares = np.sum(workspace.bank.whiten(e, workspace.noise) ** 2, axis=(1, 2))
    return trials[int(np.argmin(np.nan_to_num(squares, nan=np.inf)))]
