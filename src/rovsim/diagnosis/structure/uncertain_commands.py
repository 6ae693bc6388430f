"""When a command log does not say which command acted: no physics shows there.

A command holds until the next line. Where lines were lost, the thrusters already follow other
commands: the model pushes late, or as the lines beside them say (`lost_lines`). Where stamps of a
regular log jitter, it pushes early or late by as much.
"""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from rovsim.core.robust import LONG_STEP, robust_std
from rovsim.core.run import Commands
from rovsim.diagnosis.structure.response import respond
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.least_squares import gram, solve
from rovsim.estimation.observer.lost_lines import MAX_JITTER_SHARE
from rovsim.estimation.observer.observed_run import ObservedRun

NEARBY = 3  # lines before and after a lost one, which may have been like any of them
SPIN_UP_SECONDS = 0.3  # s within which propellers and motors follow a command
# Of all lines: at most so many lost ones count, and so many jittering ones; those with the largest
# changes.
MAX_SHARE = 0.05
MIN_JITTER_SECONDS = 5e-4  # stamps are rounded to milliseconds
JITTER_STDS = 2.0  # standard deviations of a stamp, to either side
# Standard deviations: removing a smaller push would cost more than it does harm.
MIN_REMOVED_STDS = 1.0


@dataclass(frozen=True, eq=False)
class UncertainCommands:
    """Times of a run at which another command may have acted than the log says.

    Attributes:
        run: the run.
        times: begin and end (g, 2) of each, s since the first step, as `run.time`.
        jumps: by how much (g, 6) the acceleration may have been wrong in each, m/s2 and rad/s2.
        lost: mask (g,) of those at which a line was lost. Thrusters may also follow late after it.
    """

    run: ObservedRun
    times: Array
    jumps: Array
    lost: Array

    @classmethod
    def of(cls, run: ObservedRun, model: Model) -> "UncertainCommands":
        """Find these times, and what a model makes of them."""
        commands = run.motion.commands
        gaps, jitter = find_gaps(commands), find_jittering(commands)
        lead = commands.before
        at = np.vstack([gaps, jitter]) - run.edges[0] + lead
        times = model.thrust_path.effective_time(at) - lead
        lost = np.arange(len(times)) < len(gaps)
        return cls(run, times, find_jumps(run, model, times), lost)

    @property
    def _ends(self) -> Array:
        """Until when (g,) it shows, s since the first step: until thrusters have followed.

        When in a reading a push began shows in the next one.
        """
        return self.times[:, 1] + np.where(self.lost, SPIN_UP_SECONDS, self.run.period)

    def mark(self) -> Array:
        """Mask (n,) of innovations at these times, and until thrusters have followed."""
        return mark_overlapping(self.run, np.column_stack([self.times[:, 0], self._ends]))

    def clear(self, white: Array, axis: int, f: AxisFilter) -> Array:
        """Remove from a row (n,), or rows (q, n), what any push at these times explains.

        Args:
            white: whitened settled innovations of one axis, or their derivatives.
            axis: number of the axis. What made too small a difference there is left as it is.
            f: filter of the axis.
        """
        pushes: list[Array] = []
        each = zip(self.times, self._ends, self.jumps[:, axis], strict=True)
        for (begin, end), until, by in each:
            during = self.run.overlapping(begin, end)
            response = respond(during.astype(float), f, self.run)
            share = min(1.0, (end - begin) / self.run.period)
            if by * share * np.sqrt(response @ response) > MIN_REMOVED_STDS:
                pushes += [np.arange(len(during)) == i for i in np.flatnonzero(during)]
                pushes.append(self.run.overlapping(end, until) & ~during)
        if not pushes:
            return white
        rows = respond(np.unique(np.stack(pushes), axis=0).astype(float), f, self.run)
        return white - solve(gram(rows), rows @ white.T).T @ rows


def find_gaps(commands: Commands) -> Array:
    """Find where lines were lost while commands changed: from when the first was due (g, 2), s.

    A lost line may have been as far from its neighbours as lines nearby are from each other: some
    controllers chatter. Where there are many, those about which commands changed most.
    """
    time = commands.time
    steps = np.diff(time)
    if not len(steps):
        return np.empty((0, 2))
    usual = float(np.median(steps))
    highest = maximum_filter1d(commands.value, 2 * NEARBY, axis=0)
    lowest = minimum_filter1d(commands.value, 2 * NEARBY, axis=0)
    chosen = _choose_largest((highest - lowest)[1:], steps >= LONG_STEP * usual)
    return np.column_stack([time[:-1] + usual, time[1:]])[chosen]


def find_jittering(commands: Commands) -> Array:
    """Find when lines of a regular log may have acted whose stamps jitter (g, 2), s.

    Of lines with which commands changed most; none where the log is not regular, or has no jitter.
    """
    steps = np.diff(commands.time)
    if not len(steps):
        return np.empty((0, 2))
    usual = np.median(steps)
    # of a stamp: a step has the jitter of two
    std = robust_std(steps - usual) / np.sqrt(2.0)
    if not MIN_JITTER_SECONDS < std < MAX_JITTER_SHARE * usual:
        return np.empty((0, 2))
    change = np.abs(np.diff(commands.value, axis=0))
    at = commands.time[1:][_choose_largest(change, steps < LONG_STEP * usual)]
    return at[:, None] + JITTER_STDS * std * np.array([-1.0, 1.0])


def _choose_largest(change: Array, possible: Array) -> Array:
    """Mask (m - 1,) of the possible steps of a log with the largest changes, of all its steps.

    Args:
        change: by how much each command (m - 1, c) may have changed, not negative.
        possible: mask (m - 1,) of the steps to choose from.
    """
    largest = np.where(possible, np.max(change, axis=1), 0.0)
    return np.asarray(largest > max(0.0, np.quantile(largest, 1.0 - MAX_SHARE, method="higher")))


def find_jumps(run: ObservedRun, model: Model, times: Array) -> Array:
    """By how much (g, 6) the acceleration may be wrong at times (g, 2), m/s2 and rad/s2.

    This is how much the thrust changes from before them until thrusters have followed the command
    after them.
    """
    a = run.drives.of([model])[0].wrench @ model.body.M_inv.T
    elapsed = run.edges - run.edges[0]
    begin = np.maximum(np.searchsorted(elapsed, times[:, 0]) - 2, 0)
    end = np.searchsorted(elapsed, times[:, 1] + SPIN_UP_SECONDS)
    spans = zip(begin, end, strict=True)
    return np.array([np.max(np.abs(a[i : j + 1] - a[i]), axis=0) for i, j in spans]).reshape(-1, 6)


def mark_overlapping(run: ObservedRun, times: Array) -> Array:
    """Mask (n,) of innovations that overlap any of the times (g, 2)."""
    mask = np.zeros(len(run.time), bool)
    for begin, end in times:
        mask |= run.overlapping(begin, end)
    return mask
