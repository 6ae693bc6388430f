"""Measure rate, jitter and gaps of the times in a file."""

from dataclasses import dataclass

import numpy as np
from numpy import ndarray as Array

from rovsim.core.robust import LONG_STEP

MAX_JITTER_SHARE = 0.1  # of the usual step; clocks of computers stay below


@dataclass(frozen=True)
class RowTiming:
    """Timing of the rows of a file.

    Attributes:
        rows: how many there are.
        seconds: from the first to the last.
        rate: Hz, by the median step.
        jitter: standard deviation of the steps, without long ones, over the median step.
        gaps: number of steps longer than twice the median.
        longest: step, s.
    """

    rows: int
    seconds: float
    rate: float
    jitter: float
    gaps: int
    longest: float

    @staticmethod
    def of(time: Array) -> "RowTiming":
        """Measure the timing of increasing times (n,) s, n > 1."""
        steps = np.diff(time)
        usual = float(np.median(steps))
        regular = steps[steps < LONG_STEP * usual]
        return RowTiming(
            len(time),
            float(time[-1] - time[0]),
            1.0 / usual,
            float(regular.std() / usual),
            int(np.sum(steps > 2.0 * usual)),
            float(steps.max()),
        )

    def __str__(self) -> str:
        text = f"{self.rows} rows, {self.seconds:.1f} s at {self.rate:.4g} Hz"
        if self.jitter > MAX_JITTER_SHARE:
            text += f", steps vary by {100 * self.jitter:.0f} %"
        if self.gaps == 1:
            text += f", a gap of {self.longest:.2f} s"
        elif self.gaps:
            text += f", {self.gaps} gaps, the longest {self.longest:.2f} s"
        return text
