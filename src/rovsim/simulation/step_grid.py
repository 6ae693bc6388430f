"""The integration steps of a run."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.motion import Motion


@dataclass(frozen=True, eq=False)
class StepGrid:
    """k integration steps of the same length.

    Attributes:
        edges: (k+1,) at which the steps begin and end, s on the clock of the motion.
        stride: number of steps from one sample to the next; 1 for a binned run.
        before: time from the start of the recording to the first step, s.
    """

    edges: Array
    stride: int
    before: float = 0.0

    @property
    def h(self) -> float:
        """Step length in s."""
        return float(self.edges[1] - self.edges[0])

    @property
    def time(self) -> Array:
        """The edges (k+1,) as s since the start of the recording."""
        return self.edges - self.edges[0] + self.before

    @staticmethod
    def over(motion: Motion, step: float) -> "StepGrid":
        """Divide a run into steps of at most `step` s, so that each sample falls on an edge.

        The bins of a binned run may begin between two edges.
        """
        if motion.binned:
            count = int(np.ceil((motion.end - motion.time[0]) / step - 1e-9))
            edges = motion.time[0] + step * np.arange(count + 1)
            return StepGrid(edges, 1, motion.commands.before)
        period = time_step(motion.time)
        stride = int(np.ceil(period / step - 1e-9))
        h, count = period / stride, (len(motion.time) - 1) * stride
        return StepGrid(motion.time[0] + h * np.arange(count + 1), stride, motion.commands.before)
