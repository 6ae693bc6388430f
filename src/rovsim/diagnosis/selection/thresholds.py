"""Where a threshold may lie: looked for all along its range, for derivatives do not lead there.

What is just below a threshold acts at other moments than what is just above it, so that a small
step tells nothing of a larger one: a fit moves by single lines of the log, and stops. But the sum
of squares falls all the way to where the threshold is.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.selection.workspace import SearchWorkspace

REACH = 10.0  # scales: how far from its absence a threshold is looked for
COARSE, FINE = 2.0, 0.5  # resolutions between those that are tried first, and about the best


def place_thresholds(workspace: SearchWorkspace, h: Hypothesis, term: Term) -> Hypothesis:
    """A hypothesis with the thresholds of one of its terms where they explain most.

    All else stays as it is.
    """
    own = next(k for k, one in enumerate(h.terms) if one.id == term.id)
    for column, parameter in zip(h.columns[own], h.terms[own].parameters, strict=True):
        if parameter.threshold:
            grain = parameter.resolution / parameter.scale
            away = np.arange(COARSE * grain, REACH, COARSE * grain)
            h = _choose(workspace, h, column, h.absence[column] + away)
            about = np.arange(-COARSE, COARSE + FINE, FINE) * grain
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
