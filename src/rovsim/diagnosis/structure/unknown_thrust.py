"""Times at which the command log does not say what the thrusters did: no physics shows there."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import LONG_STEP
from rovsim.dynamics.actuation import ThrustPath
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.observed_run import ObservedRun

SPIN_UP_SECONDS = 0.3  # s within which propellers and motors follow a command
MAX_LOST_SHARE = 0.05  # of all lines: at most so many count as lost, those with the largest changes


def find_lost_commands(run: ObservedRun, path: ThrustPath) -> Array:
    """Find gaps (lost lines) in the command log over which commands changed.

    Where there are many, those over which commands changed most.

    Args:
        run: with its log.
        path: says when a logged command takes effect.

    Returns:
        Begin and end (g, 2) of each gap, s since the first step, as `run.time`.
    """
    commands = run.motion.commands
    steps = np.diff(commands.time)
    if not len(steps):
        return np.empty((0, 2))
    change = np.max(np.abs(np.diff(commands.value, axis=0)), axis=1)
    change[steps < LONG_STEP * np.median(steps)] = 0.0
    jumps = change > max(0.0, np.quantile(change, 1.0 - MAX_LOST_SHARE))
    lead = commands.before
    at = path.effective_time(commands.time - run.edges[0] + lead) - lead
    return np.column_stack([at[:-1][jumps], at[1:][jumps]])


def find_jumps(run: ObservedRun, model: Model, lost: Array) -> Array:
    """By how much (g, 6) the acceleration may be wrong over gaps (g, 2), m/s2 and rad/s2.

    This is how much the thrust changes from before a gap until thrusters have followed the command
    after it.
    """
    a = run.drives.of([model])[0].wrench @ model.body.M_inv.T
    elapsed = run.edges - run.edges[0]
    begin = np.maximum(np.searchsorted(elapsed, lost[:, 0]) - 2, 0)
    end = np.searchsorted(elapsed, lost[:, 1] + SPIN_UP_SECONDS)
    spans = zip(begin, end, strict=True)
    return np.array([np.max(np.abs(a[i : j + 1] - a[i]), axis=0) for i, j in spans]).reshape(-1, 6)


def mark_undecided(h: Hypothesis, run: ObservedRun) -> Array:
    """Mask (n,) of innovations at which the log does not say whether a thruster turned.

    A command is rounded before it is logged. Near the edge of a deadband, it may have been on
    either side.
    """
    times = [find_different(run, *models) for models in _list_either_side(h)]
    return _mark_overlapping(run, np.vstack([np.empty((0, 2)), *times]))


def mark_unlogged(run: ObservedRun, lost: Array) -> Array:
    """Mask (n,) of innovations in gaps (g, 2), and after them until thrusters have followed."""
    return _mark_overlapping(run, lost + np.array([0.0, SPIN_UP_SECONDS]))


def _mark_overlapping(run: ObservedRun, times: Array) -> Array:
    """Mask (n,) of innovations that overlap any of the times (g, 2)."""
    mask = np.zeros(len(run.time), bool)
    for begin, end in times:
        mask |= run.overlapping(begin, end)
    return mask


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
