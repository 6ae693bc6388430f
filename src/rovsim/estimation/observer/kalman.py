"""Steady-state Kalman filters of one axis, and what turns the innovations of one into another's."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy import ndarray as Array
from scipy.linalg import expm

from rovsim.estimation.observer.axis_kernels import (
    BIN_MEAN,
    POSE,
    characteristic,
    solve_steady_state,
)

# s: a slow error of calibrated cameras lasts as long as the vehicle takes to leave the place where
# the calibration errs.
TYPICAL_BIAS_TIME = 0.5


class AxisErrorDynamics(NamedTuple):
    """How an error of one axis goes on: v' = -`damping` v - `stiffness` p, in 1/s and 1/s2."""

    damping: float
    stiffness: float = 0.0

    def over(self, h: float, kind: int = POSE) -> Array:
        """Transition (3, 3) over h s of pose, velocity and a push that stays.

        Where the mean velocity of bins is read, poses are taken as measured and do not err.
        """
        return _integrate(h, self.damping, 0.0 if kind == BIN_MEAN else self.stiffness)


@lru_cache(maxsize=1024)
def _integrate(h: float, damping: float, stiffness: float) -> Array:
    rates = [[0.0, 1.0, 0.0], [-stiffness, -damping, 1.0], [0.0, 0.0, 0.0]]
    found = np.ascontiguousarray(expm(h * np.array(rates)))
    found.flags.writeable = False
    return found


class AxisNoise(NamedTuple):
    """Noise of one axis: a disturbance (m/s2, rad/s2) and errors of the readings (in their units).

    The disturbance has a `correlation_time` in s. Errors are white with `measurement_std`; beside
    them a slow one may last: a bias that changes.
    """

    disturbance_std: float
    correlation_time: float
    measurement_std: float
    bias_std: float = 0.0
    bias_correlation_time: float = TYPICAL_BIAS_TIME


@dataclass(frozen=True, eq=False)
class AxisFilter:
    """Filter of one axis: `F` (n, n), `C` and `gain` (n,), variance of its innovations.

    `denominator` (n + 1,): its characteristic polynomial, highest power first; `noise_denominator`:
    that of the disturbance and of a slow error of the readings, which other filters do not share.
    """

    F: Array
    C: Array
    gain: Array
    variance: float
    denominator: Array
    noise_denominator: Array

    @property
    def decay(self) -> float:
        """What remains of the disturbance after one period."""
        place = min(2, len(self.C) - 1)  # behind velocity, and the pose where it is read
        return float(self.F[place, place])

    def whitening(self, old: "AxisFilter") -> tuple[Array, Array]:
        """Rational filter (b, a) that turns innovations of the filter `old` into this one's."""
        return (
            np.convolve(self.noise_denominator, old.denominator),
            np.convolve(old.noise_denominator, self.denominator),
        )

    @cached_property
    def response(self) -> tuple[Array, Array]:
        """Filter (b, a) from a push on the axis (m/s2, rad/s2) to innovations of unit variance.

        C (z I - A)^-1 B = det(z I - A + B C) / det(z I - A) - 1 with A = F (I - K C).
        """
        n = len(self.C)
        A = self.F @ (np.eye(n) - np.outer(self.gain, self.C))
        B = np.zeros(n)
        if n == 2:
            B[0] = self.F[0, 1]
        else:
            B[:2] = self.F[:2, 2]
        b = characteristic(A - np.outer(B, self.C)) - self.denominator
        return b / np.sqrt(self.variance), self.denominator


def design_filter(kind: int, h: float, dynamics: AxisErrorDynamics, noise: AxisNoise) -> AxisFilter:
    """The filter of one axis for one noise (noise.py), readings every h s."""
    return AxisFilter(*solve_steady_state(kind, h, dynamics.over(h, kind), *noise))
