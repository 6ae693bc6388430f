"""Where a model diverges, however the observer corrects it: nothing can be learned there.

A filter corrects what is measured. A vehicle that tumbles while nobody measures how fast it moves
ahead and sideways may carry a model there to infinity.
"""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.observer.noise_fit import MAX_CORRELATION_TIME
from rovsim.estimation.observer.observed_run import ObservedRun


class ModelDiverged(Exception):
    """Innovations e (6, n) of each run are not finite everywhere."""

    def __init__(self, e: Sequence[Array]) -> None:
        super().__init__("the model diverges from the recordings")
        self.finite = [np.isfinite(e_run).all(axis=0) for e_run in e]

    def leave_out(self, runs: Sequence[ObservedRun]) -> tuple[list[ObservedRun], dict[str, float]]:
        """The same runs, or longer ones, without those stretches; from which s on, by run.

        A stretch begins as long before as a disturbance is remembered.
        """
        finite_runs, begins = [], {}
        for run, finite in zip(runs, self.finite, strict=True):
            if not finite.all():
                diverged, time = run.time[: len(finite)][~finite], run.motion.time
                begin = float(diverged[0]) - MAX_CORRELATION_TIME
                run = run.limited((time < begin) | (time > diverged[-1]))
                begins[run.motion.run.id] = max(begin, float(time[0]))
            finite_runs.append(run)
        return finite_runs, begins


def require_finite(e: Sequence[Array]) -> None:
    """Refuse to go on where innovations e (6, n) of some run are not finite.

    Raises:
        ModelDiverged: they are not.
    """
    if not all(np.isfinite(e_run).all() for e_run in e):
        raise ModelDiverged(e)
