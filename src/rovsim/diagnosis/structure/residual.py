"""What a fit leaves on one axis, and how a further push on that axis would show in it."""

from dataclasses import dataclass
from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.diagnosis.structure.response import respond
from rovsim.diagnosis.structure.uncertain_commands import UncertainCommands
from rovsim.diagnosis.structure.unknown_thrust import mark_undecided
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.kalman import AxisFilter
from rovsim.estimation.observer.observed_run import ObservedRun

FALSE_ALARM_RATE = 0.002  # of all tests of one kind of structure together
MIN_SIZE_STDS = 0.25  # of the disturbance's standard deviation: less changes no score
# Disturbances of axes that nobody measured reach the others through couplings of the motion, and
# sums of channels err together: what is left is not quite white. Of development recordings replayed
# with the true model, three of 36 had a structure at 1.0 to 1.3 times the limit of white noise.
CHANNELS_LIMIT_FACTOR = 1.5  # times the limit, where channels were measured and not full poses


@dataclass(frozen=True)
class Structure:
    """Something that the remainder depends on by more than chance.

    Attributes:
        axis: by name.
        what: the remainder depends on, as a person reads it.
        share: of the remaining disturbance's power.
        times_limit: its test statistic, over the limit that chance allows.
        moment: whether it is a single push, in whose place no effect can be accepted.
    """

    axis: str
    what: str
    share: float
    times_limit: float
    moment: bool = False


@dataclass(frozen=True, eq=False)
class AxisResidual:
    """What a fit leaves on one axis.

    Attributes:
        axis: by name.
        white: whitened settled innovations (n_run,) of each run.
        fitted: derivatives (k, n) of these, over all runs, to the k fitted parameters. What lies
            along them was explained already, and is not tested again.
        runs: the runs.
        filters: of each run, that whitened it.
        disturbance_std: m/s2 or rad/s2.
        undecided: mask (n_run,) of each run: where nobody knows whether a thruster turned.
        uncertain: mask (n_run,) of each run: where another command may have acted than was logged.
    """

    axis: str
    white: tuple[Array, ...]
    fitted: Array
    runs: tuple[ObservedRun, ...]
    filters: tuple[AxisFilter, ...]
    disturbance_std: float
    undecided: tuple[Array, ...]
    uncertain: tuple[Array, ...]

    @property
    def of_channels(self) -> bool:
        """Whether in some run only channels were measured, not full poses."""
        return any(run.motion.measured is not None for run in self.runs)

    @property
    def _margin(self) -> float:
        """Factor of the limits that chance allows, as what is left of channels is not white."""
        return CHANNELS_LIMIT_FACTOR if self.of_channels else 1.0

    def respond(self, disturbances: Sequence[Array]) -> Array:
        """Filter pushes (n_run,) of each run, m/s2 or rad/s2, as the innovations would show them.

        Returns:
            The response (n,) in the whitened settled innovations of all runs, one after the other.
        """
        inputs = zip(disturbances, self.filters, self.runs, strict=True)
        return np.concatenate([respond(disturbance, f, run) for disturbance, f, run in inputs])

    def weigh(
        self, what: str, *, size: float, statistic: float, limit: float, moment: bool = False
    ) -> Iterator[Structure]:
        """Yield a structure if it is beyond chance, and not negligible beside the disturbance.

        Args:
            what: the remainder depends on.
            size: RMS of the push, m/s2 or rad/s2.
            statistic: chi-square of what it explains.
            limit: that chance allows, for white innovations.
            moment: whether it is a single push.
        """
        limit *= self._margin
        if statistic > limit and size > MIN_SIZE_STDS * self.disturbance_std:
            share = min(1.0, (size / self.disturbance_std) ** 2)
            yield Structure(self.axis, what, float(share), float(statistic / limit), moment)


def split_by_axis(fit: Fit, bank: FilterBank) -> list[AxisResidual]:
    """Split what a fit leaves by axis, and remove what an uncertain command log may have caused.

    Axes that were not in every reading are left out, as their filters run at another rate.
    """
    J = bank.whiten(fit.linearised.J, fit.noise)
    white = split_by_run(bank.whiten(fit.linearised.e, fit.noise), bank.runs)
    run_filters = bank.design_filters(fit.noise)
    commands = [UncertainCommands.of(run, fit.hypothesis.model) for run in bank.runs]
    uncertain = tuple(of_run.mark()[of_run.run.settled] for of_run in commands)
    undecided = tuple(mark_undecided(fit.hypothesis, run)[run.settled] for run in bank.runs)
    residuals = []
    for i, axis in enumerate(AXES):
        if not all(run.innovation_mask[:, i].all() for run in bank.runs):
            continue
        filters = tuple(r.filters[i] for r in run_filters)
        inputs = zip(white, filters, commands, strict=True)
        cleared = tuple(of_run.clear(w[i], i, f) for w, f, of_run in inputs)
        std = float(fit.noise.disturbance_std[i])
        residuals.append(
            AxisResidual(axis, cleared, J[:, i], bank.runs, filters, std, undecided, uncertain)
        )
    return residuals


def split_by_run(white: Array, runs: Sequence[ObservedRun]) -> list[Array]:
    """Split whitened innovations (6, n) of all runs into those (6, n_run) of each run."""
    counts = np.cumsum([int(run.settled.sum()) for run in runs])[:-1]
    return np.split(white, counts, axis=-1)
