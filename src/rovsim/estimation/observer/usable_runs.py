"""The runs that a model is judged by: what they can show, and whether that is enough."""

from dataclasses import dataclass, field, replace
from typing import Mapping, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.measurement.quality.excitation import MIN_SPREAD
from rovsim.measurement.signals.measured import find_measured

MIN_SETTLED_SECONDS = 10.0  # s of settled readings; less does not tell noise from physics


@dataclass(frozen=True, eq=False)
class UsableRuns:
    """The runs that have a usable stretch, and what they can show. Axes go by name.

    Attributes:
        runs: these runs.
        still: axes that were measured, along which the vehicle hardly moved.
        unmeasured: axes that nobody measured.
        locked_axes: axes in which the vehicle cannot move.
        seconds: of settled readings in all runs.
        diverged_from: by run id, time in s from which on a run is left out: the model diverges.
    """

    runs: tuple[ObservedRun, ...]
    still: tuple[str, ...]
    unmeasured: tuple[str, ...]
    locked_axes: tuple[str, ...]
    seconds: float
    diverged_from: Mapping[str, float] = field(default_factory=dict)

    @property
    def enough(self) -> bool:
        """Whether anything can be judged."""
        return self.seconds >= MIN_SETTLED_SECONDS and len(self.moved) > 0

    @property
    def moved(self) -> tuple[str, ...]:
        """Axes that were measured and moved: only about these something can be said."""
        unexcited = (*self.still, *self.unmeasured, *self.locked_axes)
        return tuple(axis for axis in AXES if axis not in unexcited)

    def where_no_water_wanders(self) -> "UsableRuns":
        """The same runs, in which no wandering current is looked for."""
        return replace(self, runs=tuple(replace(run, current_may_drift=False) for run in self.runs))


def select_usable(
    train: Sequence[ObservedRun], diverged_from: Mapping[str, float] | None = None
) -> UsableRuns:
    """Select the train runs that have a usable stretch; for `diverged_from` see `UsableRuns`."""
    runs = tuple(run for run in train if len(run.segments))
    seconds = float(sum(run.settled.sum() * run.period for run in runs))
    free, measured, excited = _find_axes(runs)
    at_rest, unmeasured, locked = measured & free & ~excited, free & ~measured, ~free
    return UsableRuns(
        runs, _name(at_rest), _name(unmeasured), _name(locked), seconds, diverged_from or {}
    )


def _name(axes: Array) -> tuple[str, ...]:
    return tuple(np.array(AXES)[axes].tolist())


class _Axes(NamedTuple):
    """Axes (6,) in which the vehicle can move, that were measured, and that moved, in any run."""

    free: Array
    measured: Array
    moved: Array


def _find_axes(runs: Sequence[ObservedRun]) -> _Axes:
    """What the axes do in these runs."""
    free, measured, excited = (np.zeros(len(AXES), bool) for _ in range(3))
    for run in runs:
        free |= run.free_axes
        measured |= find_measured(run.motion.measured)
        excited |= np.std(run.motion.nu[run.motion.usable], axis=0) > MIN_SPREAD
    return _Axes(free, measured, excited)
