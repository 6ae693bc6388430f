"""Steady-state Kalman filters of one axis, and how innovations of one become another's."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy import ndarray as Array
from scipy.linalg import expm

from rovsim.estimation.kernels.axis import (
    BIN_MEAN,
    POSE,
    characteristic,
    solve_steady_state,
)

# s: a slow error of calibrated cameras lasts as long as the vehicle stays where the calibration is
# off.
TYPICAL_BIAS_TIME = 0.5


class AxisErrorDynamics(NamedTuple):
    """How an error of a model grows or decays on one axis: v' = -damping v - stiffness p.

    p is the error of the pose (m, rad) and v that of the velocity; `damping` is in 1/s and
    `stiffness` in 1/s2.
    """

    damping: float
    stiffness: float = 0.0

    def over(self, h: float, kind: int = POSE) -> Array:
        """Transition (3, 3) over h s of the errors of pose and velocity, and of a constant push.

        `kind` is that of the readings (see `kernels.axis`). Where they are mean velocities over
        bins, poses are taken as measured, so that an error of the pose has no effect.
        """
        return _integrate(h, self.damping, 0.0 if kind == BIN_MEAN else self.stiffness)


@lru_cache(maxsize=1024)
def _integrate(h: float, damping: float, stiffness: float) -> Array:
    rates = [[0.0, 1.0, 0.0], [-stiffness, -damping, 1.0], [0.0, 0.0, 0.0]]
    transition = np.ascontiguousarray(expm(h * np.array(rates)))
    transition.flags.writeable = False  # the cache hands the same array to everybody
    return transition


class AxisNoise(NamedTuple):
    """The disturbance on one axis, and the noise of its readings.

    Attributes:
        disturbance_std: of the disturbance, m/s2 or rad/s2.
        correlation_time: of the disturbance, s.
        measurement_std: of the white noise of the readings, in their unit.
        bias_std: of a slow error of the readings, in their unit; 0 where there is none.
        bias_correlation_time: of that error, s.
    """

    disturbance_std: float
    correlation_time: float
    measurement_std: float
    bias_std: float = 0.0
    bias_correlation_time: float = TYPICAL_BIAS_TIME


@dataclass(frozen=True, eq=False)
class AxisFilter:
    """The steady-state Kalman filter of one axis, with n states (noise.py).

    Attributes:
        F: transition (n, n) from one reading to the next.
        C: output row (n,): what is read of the states.
        gain: (n,) correction of the states per unit of innovation.
        variance: of the innovations, in the unit of the readings squared.
        denominator: (n + 1,) characteristic polynomial of the filter, highest power first.
        noise_denominator: likewise of the disturbance and of the slow error alone. These depend on
            the noise, whereas all filters of an axis have the error dynamics in common.
    """

    F: Array
    C: Array
    gain: Array
    variance: float
    denominator: Array
    noise_denominator: Array

    @property
    def decay(self) -> float:
        """Share of the disturbance that remains after one period."""
        place = min(2, len(self.C) - 1)  # the disturbance is the last of (p, v, a) or of (v, a)
        return float(self.F[place, place])

    def whitening(self, old: "AxisFilter") -> tuple[Array, Array]:
        """Rational filter (b, a) that turns innovations of the filter `old` into those of this."""
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

    def respond_at(self, z: Array) -> Array:
        """Frequency response (k,), complex, of `response` at z = exp(i w h) (k,)."""
        b, a = self.response
        return np.asarray(np.polyval(b, z) / np.polyval(a, z))


def design_filter(kind: int, h: float, dynamics: AxisErrorDynamics, noise: AxisNoise) -> AxisFilter:
    """Design the filter of one axis for readings of a `kind` (`kernels.axis`) every h s."""
    return AxisFilter(*solve_steady_state(kind, h, dynamics.over(h, kind), *noise))
