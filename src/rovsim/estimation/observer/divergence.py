"""Where the observer loses a model, however it is corrected: nothing can be learned there.

A filter corrects what is measured. A vehicle that tumbles while nobody measures how fast it moves
ahead and sideways may carry a model there to infinity.
"""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.observer.noise_fit import MAX_CORRELATION_TIME
from rovsim.estimation.observer.observed_run import ObservedRun


class ModelLost(Exception):
    """Innovations e (6, n) of each run are not finite everywhere."""

    def __init__(self, e: Sequence[Array]) -> None:
        super().__init__("the model runs away from the recordings")
        self.finite = [np.isfinite(one).all(axis=0) for one in e]

    def leave_out(self, runs: Sequence[ObservedRun]) -> tuple[list[ObservedRun], dict[str, float]]:
        """The same runs, or longer ones, without those stretches; from which s on, by run.

        A stretch begins as long before as a disturbance is remembered.
        """
        kept, lost = [], {}
        for run, finite in zip(runs, self.finite, strict=True):
            if not finite.all():
                away, time = run.time[: len(finite)][~finite], run.motion.time
                begin = float(away[0]) - MAX_CORRELATION_TIME
                run = run.limited((time < begin) | (time > away[-1]))
                lost[run.motion.run.id] = max(begin, float(time[0]))
            kept.append(run)
        return kept, lost


def require_finite(e: Sequence[Array]) -> None:
    """Refuse to go on where innovations e (6, n) of some run are not finite.

    Raises:
        ModelLost: they are not.
    """
    if not all(np.isfinite(one).all() for one in e):
        raise ModelLost(e)
