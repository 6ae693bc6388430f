"""Body velocities and accelerations from poses."""

from typing import Annotated, Literal, TypeAlias

import numpy as np
import scipy
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core import rotations
from rovsim.core.schema import Section
from rovsim.measurement.signals.filter import odd_window


class _Margin(Section):
    # s dropped at either end of a stretch, where the filter sees one side only. Half a period of a
    # 5 Hz filter: noise there is 1.3 times that of the interior in nu and 1.1 times in nu_dot, at
    # the very end 7 times
    margin: float = Field(default=0.1, ge=0)


class Spline(_Margin):
    """Derivatives of the cubic spline through the samples (not-a-knot ends)."""

    kind: Literal["spline"] = "spline"

    def derivatives(self, x: Array, dt: float) -> tuple[Array, Array]:
        """First and second time derivative of `x` (..., time, channels)."""
        first, second, time = np.empty_like(x), np.empty_like(x), dt * np.arange(x.shape[-2])
        for k in range(x.shape[-1]):  # one by one: a spline takes ten times its channel's memory
            spline = scipy.interpolate.CubicSpline(time, x[..., k], axis=-1)
            first[..., k], second[..., k] = spline(time, 1), spline(time, 2)
        return first, second


class Central(_Margin):
    """Central differences, exact for parabolas; one-sided ones of the same kind at the ends."""

    kind: Literal["central"] = "central"

    def derivatives(self, x: Array, dt: float) -> tuple[Array, Array]:
        """First and second time derivative of `x` (..., time, channels)."""
        first = np.gradient(x, dt, axis=-2, edge_order=2)
        second = np.empty_like(first)
        second[..., 1:-1, :] = np.diff(x, 2, axis=-2) / dt**2
        second[..., 0, :], second[..., -1, :] = second[..., 1, :], second[..., -2, :]
        return first, second


class SavitzkyGolay(_Margin):
    """Derivatives of least-squares polynomials in a sliding window; smooths as well."""

    kind: Literal["savgol"] = "savgol"
    # s: short beside the filter's 0.2 s, so that the filter decides what is smoothed
    window: float = Field(default=0.07, gt=0)
    degree: int = Field(default=3, ge=2, le=5)

    def derivatives(self, x: Array, dt: float) -> tuple[Array, Array]:
        """First and second time derivative of `x` (..., time, channels)."""
        width = max(3, odd_window(self.window, dt, x.shape[-2]))  # a parabola at least
        degree = min(self.degree, width - 1)
        first, second = (
            scipy.signal.savgol_filter(x, width, degree, deriv=d, delta=dt, axis=-2, mode="interp")
            for d in (1, 2)
        )
        return first, second


Differentiation: TypeAlias = Annotated[
    Spline | Central | SavitzkyGolay, Field(discriminator="kind")
]


def differentiate_eta(eta: Array, dt: float, settings: Differentiation) -> tuple[Array, Array]:
    """Body velocity and acceleration (..., time, 6) of poses (..., time, 7), `dt` s apart.

    v = R^T p', v' = R^T p'' - omega x v, omega = 2 q* q' (Fossen 2021, sec. 2.2 and eq. 2.78).

    Args:
        eta: positions NED, m, and sign-continuous unit quaternions (w, x, y, z) from FRD to NED.
        dt: time between samples, s.
        settings: how components are differentiated.

    Returns:
        Velocities (m/s, rad/s) and accelerations (m/s2, rad/s2) of the body axes FRD; NaN with
        fewer than three samples.
    """
    if eta.shape[-2] < 3:
        nothing = np.full((*eta.shape[:-1], 6), np.nan)
        return nothing, nothing.copy()
    first, second = settings.derivatives(eta, dt)
    q = eta[..., 3:]
    v, omega = rotations.unrotate(q, first[..., :3]), rotations.body_rates(q, first[..., 3:])
    v_dot = rotations.unrotate(q, second[..., :3]) - np.cross(omega, v)
    omega_dot = rotations.body_rate_derivative(q, second[..., 3:])
    return np.concatenate([v, omega], axis=-1), np.concatenate([v_dot, omega_dot], axis=-1)
