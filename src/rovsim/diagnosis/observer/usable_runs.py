"""The runs a model is judged by: what they can show, and whether that is enough."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np

from rovsim import AXES
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.measurement.quality import EXCITED

SHORTEST = 10.0  # s of settled readings; less does not tell noise from physics


@dataclass(frozen=True, eq=False)
class UsableRuns:
    """Runs with something to observe, axes that none of them moved, and s of settled readings."""

    runs: tuple[ObservedRun, ...]
    still: tuple[str, ...]
    seconds: float

    @property
    def enough(self) -> bool:
        """Whether anything can be judged."""
        return self.seconds >= SHORTEST and len(self.still) < len(AXES)

    @property
    def moved(self) -> tuple[str, ...]:
        """Axes about which something can be said."""
        return tuple(axis for axis in AXES if axis not in self.still)


def select_usable(train: Sequence[ObservedRun]) -> UsableRuns:
    """The train runs that have a usable stretch."""
    runs = tuple(run for run in train if len(run.spans))
    seconds = float(sum(run.settled.sum() * run.period for run in runs))
    return UsableRuns(runs, _find_still(runs), seconds)


def _find_still(runs: Sequence[ObservedRun]) -> tuple[str, ...]:
    """Axes that no run moved: nothing can be said about them."""
    moved = np.zeros(len(AXES), bool)
    for run in runs:
        moved |= np.std(run.motion.nu[run.motion.usable], axis=0) > EXCITED
    return tuple(axis for axis, yes in zip(AXES, moved, strict=True) if not yes)
