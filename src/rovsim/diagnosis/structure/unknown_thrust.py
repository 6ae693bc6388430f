"""Times at which the command log does not say whether a thruster turned.

A command is rounded before it is logged. Near the edge of a deadband, it may have been on either
side: no physics shows there.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.structure.uncertain_commands import mark_overlapping
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.observed_run import ObservedRun


def mark_undecided(h: Hypothesis, run: ObservedRun) -> Array:
    """Mask (n,) of innovations at which the log does not say whether a thruster turned."""
    times = [find_different(run, *models) for models in _list_either_side(h)]
    return mark_overlapping(run, np.vstack([np.empty((0, 2)), *times]))


def find_different(run: ObservedRun, one: Model, other: Model) -> Array:
    """Times (g, 2) at which two models' thrusters push differently under the same commands."""
    forces = [drive.force for drive in run.drives.of([one, other])]
    differ = (forces[0] != forces[1]).any(axis=1)
    turns = np.flatnonzero(np.diff(np.concatenate([[False], differ, [False]])))
    return np.asarray((run.edges - run.edges[0])[turns].reshape(-1, 2))


def _list_either_side(h: Hypothesis) -> list[tuple[Model, Model]]:
    """For each threshold two models, with its value half a resolution lower and higher."""
    pairs = []
    for term, columns in zip(h.terms, h.columns, strict=True):
        for parameter, column in zip(term.parameters, columns, strict=True):
            if parameter.tried:
                half = np.zeros(len(h.x))
                half[column] = 0.5 * parameter.resolution / parameter.scale
                pairs.append((h.at(h.x - half).model, h.at(h.x + half).model))
    return pairs
