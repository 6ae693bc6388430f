"""What is left on one axis after the best model, and how a push there would show in it."""

from dataclasses import dataclass
from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter

from rovsim import AXES
from rovsim.diagnosis.structure.unknown_thrust import (
    SPIN,
    find_jumps,
    find_lost_commands,
    mark_undecided,
    mark_unlogged,
)
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.observed_run import ObservedRun

FALSE_ALARM = 0.002  # of all looks together, for each kind of structure
MATTERS = 0.25  # of the disturbance's standard deviation: less does not show in any score
# Disturbances of axes that nobody measured reach the others through couplings of the motion, and
# sums of channels err together: what is left is not quite white. Of development recordings replayed
# with the true model, three of 36 had a structure at 1.0 to 1.3 times the limit of white noise.
CHANNELS = 1.5  # times the limit, where channels were measured and not full poses
NOTICED = 1.0  # standard deviations: less of a push nobody sees, and to take it out costs readings


@dataclass(frozen=True)
class Structure:
    """Something the remainder varies with.

    `share` of the remaining disturbance's power; `times_limit`: its statistic, over what chance
    allows; `moment`: it is a single push, for which no effect can stand in.
    """

    axis: str
    what: str
    share: float
    times_limit: float
    moment: bool = False


@dataclass(frozen=True, eq=False)
class AxisResidual:
    """Whitened settled innovations (n_run,) of one axis, and the filter that made each run white.

    `fitted` (k, n), over all runs, are their derivatives to what was fitted, whose directions are
    not judged again; `disturbance_std` in m/s2 or rad/s2; `undecided` (n_run,): where nobody knows
    whether a thruster turned; `unlogged` (n_run,): where thrusters follow a command that was lost.
    """

    axis: str
    white: tuple[Array, ...]
    fitted: Array
    runs: tuple[ObservedRun, ...]
    filters: tuple[AxisFilter, ...]
    disturbance_std: float
    undecided: tuple[Array, ...]
    unlogged: tuple[Array, ...]

    @property
    def of_channels(self) -> bool:
        """Whether channels were measured in some run, and not full poses."""
        return any(run.motion.measured is not None for run in self.runs)

    @property
    def _margin(self) -> float:
        return CHANNELS if self.of_channels else 1.0

    def respond(self, pushes: Sequence[Array]) -> Array:
        """How pushes (n_run,) on the runs would show (n,) over all of them."""
        each = zip(pushes, self.filters, self.runs, strict=True)
        return np.concatenate([respond(push, f, run) for push, f, run in each])

    def weigh(
        self, what: str, *, size: float, statistic: float, limit: float, moment: bool = False
    ) -> Iterator[Structure]:
        """A structure where it is beyond chance, and large enough beside the disturbance.

        Args:
            what: it varies with.
            size: RMS of the push, m/s2 or rad/s2.
            statistic: chi-square of what it explains.
            limit: what chance allows this to be.
            moment: it is a single push.
        """
        limit *= self._margin
        if statistic > limit and size > MATTERS * self.disturbance_std:
            share = min(1.0, (size / self.disturbance_std) ** 2)
            yield Structure(self.axis, what, float(share), float(statistic / limit), moment)


def respond(push: Array, f: AxisFilter, run: ObservedRun) -> Array:
    """How a push (n,) on one axis shows in the settled innovations of one run."""
    b, a = f.response
    out = np.empty(len(run.time))
    for first, last in run.innovation_segments:
        out[first:last] = lfilter(b, a, push[first:last])
    return out[run.settled]


def split_by_axis(fit: Fit, bank: FilterBank) -> list[AxisResidual]:
    """What a fit leaves, axis by axis, without what a gap in the command log may have done.

    Axes that not every reading shows are left out: their filters have another clock.
    """
    J = bank.whiten(fit.linearised.J, fit.noise)
    white = _split_by_run(bank.whiten(fit.linearised.e, fit.noise), bank.runs)
    run_filters = bank.design_filters(fit.noise)
    model = fit.hypothesis.model
    unknown = [find_lost_commands(run, model.thrust_path) for run in bank.runs]
    pairs = list(zip(bank.runs, unknown, strict=True))
    off = [find_jumps(run, model, lost) for run, lost in pairs]
    unlogged = tuple(mark_unlogged(run, lost)[run.settled] for run, lost in pairs)
    undecided = tuple(mark_undecided(fit.hypothesis, run)[run.settled] for run in bank.runs)
    residuals = []
    for i, axis in enumerate(AXES):
        if not all(run.innovation_mask[:, i].all() for run in bank.runs):
            continue
        filters = tuple(one.filters[i] for one in run_filters)
        each = zip(white, filters, bank.runs, unknown, off, strict=True)
        cleared = tuple(_clear(own[i], f, run, lost, by[:, i]) for own, f, run, lost, by in each)
        std = float(fit.noise.disturbance_std[i])
        residuals.append(
            AxisResidual(axis, cleared, J[:, i], bank.runs, filters, std, undecided, unlogged)
        )
    return residuals


def _split_by_run(white: Array, runs: Sequence[ObservedRun]) -> list[Array]:
    counts = np.cumsum([int(run.settled.sum()) for run in runs])[:-1]
    return np.split(white, counts, axis=-1)


def _clear(w: Array, f: AxisFilter, run: ObservedRun, lost: Array, off: Array) -> Array:
    """Without what the vehicle did while the log does not say what it was told.

    Where it may have been `off` (g,) by enough to be noticed over lost lines (g, 2).
    """
    columns = []
    for (begin, end), by in zip(lost, off, strict=True):
        during = respond(run.overlapping(begin, end).astype(float), f, run)
        share = min(1.0, (end - begin) / run.period)
        if by * share * np.sqrt(during @ during) > NOTICED:
            columns += [during, respond(run.overlapping(end, end + SPIN).astype(float), f, run)]
    if not columns:
        return w
    rows = np.stack(columns)
    return w - solve(rows @ rows.T, rows @ w) @ rows
