"""Lines that a command log lost: what the vehicle did meanwhile says nothing about its physics.

A command holds until the next line. Where a line was lost, the thrusters already follow another
command, so the model pushes late, by a line at each of them.
"""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import LONG_STEP
from rovsim.diagnosis.structure.response import respond
from rovsim.dynamics.actuation import ThrustPath
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.least_squares import gram, solve
from rovsim.estimation.observer.observed_run import ObservedRun

SPIN_UP_SECONDS = 0.3  # s within which propellers and motors follow a command
MAX_LOST_SHARE = 0.05  # of all lines: at most so many count as lost, those with the largest changes
# Standard deviations: removing a smaller push would cost more than it does harm.
MIN_REMOVED_STDS = 1.0


@dataclass(frozen=True, eq=False)
class LostCommands:
    """Gaps in the command log of a run, over which commands changed.

    Attributes:
        run: the run.
        times: begin and end (g, 2) of each gap, s since the first step.
        jumps: by how much (g, 6) the acceleration may have been wrong in each, m/s2 and rad/s2.
    """

    run: ObservedRun
    times: Array
    jumps: Array

    @classmethod
    def of(cls, run: ObservedRun, model: Model) -> "LostCommands":
        """Find the gaps of a run, and what a model makes of them."""
        times = find_lost_commands(run, model.thrust_path)
        return cls(run, times, find_jumps(run, model, times))

    def mark(self) -> Array:
        """Mask (n,) of innovations in gaps, and after them until thrusters have followed."""
        return mark_overlapping(self.run, self.times + np.array([0.0, SPIN_UP_SECONDS]))

    def clear(self, white: Array, axis: int, f: AxisFilter) -> Array:
        """Remove from a row (n,), or rows (q, n), what pushes in the gaps and after them explain.

        Args:
            white: whitened settled innovations of one axis, or their derivatives.
            axis: number of the axis. A gap that made too small a difference there is left as it is.
            f: filter of the axis.
        """
        columns = []
        for (begin, end), by in zip(self.times, self.jumps[:, axis], strict=True):
            response = self._push(begin, end, f)
            share = min(1.0, (end - begin) / self.run.period)
            if by * share * np.sqrt(response @ response) > MIN_REMOVED_STDS:
                columns += [response, self._push(end, end + SPIN_UP_SECONDS, f)]
        if not columns:
            return white
        rows = np.stack(columns)
        return white - solve(gram(rows), rows @ white.T).T @ rows

    def _push(self, begin: float, end: float, f: AxisFilter) -> Array:
        return respond(self.run.overlapping(begin, end).astype(float), f, self.run)


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


def mark_overlapping(run: ObservedRun, times: Array) -> Array:
    """Mask (n,) of innovations that overlap any of the times (g, 2)."""
    mask = np.zeros(len(run.time), bool)
    for begin, end in times:
        mask |= run.overlapping(begin, end)
    return mask
