"""The runs a model is judged by: what they can show, and whether that is enough."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.measurement.quality import EXCITED
from rovsim.measurement.signals.measured import find_measured

SHORTEST = 10.0  # s of settled readings; less does not tell noise from physics


@dataclass(frozen=True, eq=False)
class UsableRuns:
    """Runs with something to observe, and s of settled readings.

    `still` axes that were measured, and none of them moved; `unmeasured` those nobody measured.
    """

    runs: tuple[ObservedRun, ...]
    still: tuple[str, ...]
    unmeasured: tuple[str, ...]
    seconds: float

    @property
    def enough(self) -> bool:
        """Whether anything can be judged."""
        return self.seconds >= SHORTEST and len(self.moved) > 0

    @property
    def moved(self) -> tuple[str, ...]:
        """Axes about which something can be said."""
        return tuple(axis for axis in AXES if axis not in (*self.still, *self.unmeasured))


def select_usable(train: Sequence[ObservedRun]) -> UsableRuns:
    """The train runs that have a usable stretch."""
    runs = tuple(run for run in train if len(run.spans))
    seconds = float(sum(run.settled.sum() * run.period for run in runs))
    each = np.array([find_measured(run.motion.measured) for run in runs]).reshape(-1, len(AXES))
    measured = np.asarray(each.any(axis=0) if runs else np.ones(len(AXES), bool))
    return UsableRuns(runs, _name(measured & ~_find_moved(runs)), _name(~measured), seconds)


def _name(axes: Array) -> tuple[str, ...]:
    return tuple(np.array(AXES)[axes].tolist())


def _find_moved(runs: Sequence[ObservedRun]) -> Array:
    """Which axes (6,) some run moved: nothing can be said about the others."""
    moved = np.zeros(len(AXES), bool)
    for run in runs:
        moved |= np.std(run.motion.nu[run.motion.usable], axis=0) > EXCITED
    return moved
