"""Low-passes by which a motion capture smooths the poses it reports, and what they smoothed.

Filters are linear, so a pose and its derivatives pass them alike: (..., 7 k) channels of a pose
(position and quaternion), its first derivative, …, in world axes.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core.rotations import (
    body_rate_derivative,
    body_rates,
    multiply,
    normalized,
    rotate,
    unrotate,
)


@dataclass(frozen=True)
class LowPass:
    """First-order low-passes one after the other, by their `time_constants` in s.

    Software works sample by sample: y_k = a y_{k-1} + (1 - a) x_k with a = exp(-dt / T), which
    delays slow motions by a dt / (1 - a), about T - dt / 2.
    """

    time_constants: tuple[float, ...] = ()

    def smooth(
        self, x: Array, dt: float | Array, first: Array | None = None, straight: bool = False
    ) -> Array:
        """Channels (..., n, c), dt s apart, as they leave the last stage.

        Args:
            x: what enters.
            dt: s between two samples, one or (n-1,).
            first: (stages, ..., c) that left each stage at the first sample; None: it stood still.
            straight: the software saw more samples, on straight lines between these.
        """
        for k, T in enumerate(self.time_constants):
            begin = x[..., 0, :] if first is None else first[k]
            x = _lag(x, begin, *(_weigh_lines if straight else _weigh_samples)(dt / T))
        return x

    def pass_power(self, frequency: Array, dt: float) -> Array:
        """Share (f,) of the power at each frequency (f,) Hz that leaves the last stage."""
        a = np.exp(-dt / np.array(self.time_constants))[:, None]
        turn = np.cos(2.0 * np.pi * frequency * dt)
        return np.asarray(np.prod((1.0 - a) ** 2 / (1.0 - 2.0 * a * turn + a * a), axis=0))

    def stages(self, y: Array, dt: float) -> Array:
        """What entered the first stage, and what left each (stages + 1, n, c), of outputs (n, c).

        The exact inverse of `smooth`, but for the first two samples, before which it takes the
        motion for straight.
        """
        found = [y]
        for T in reversed(self.time_constants):
            a = np.exp(-dt / T)
            found.append((found[-1] - a * _delayed(found[-1])) / (1.0 - a))
        return np.stack(found[::-1])

    def stages_of_derivatives(self, derivatives: Array) -> Array:
        """The same (stages + 1, d, n, c) of an output and its derivatives (d, n, c): x = y + T y'.

        For instants too far apart to tell a derivative; the next one is taken for zero.
        """
        found = [derivatives]
        for T in reversed(self.time_constants):
            following = np.concatenate([found[-1][1:], np.zeros_like(derivatives[:1])])
            found.append(found[-1] + T * following)
        return np.stack(found[::-1])


def _weigh_samples(step: float | Array) -> tuple[Array, Array, Array]:
    """Weights of the output before, and of the inputs before and now; `step` in time constants."""
    kept = np.exp(-np.asarray(step))
    return kept, np.zeros_like(kept), 1.0 - kept


def _weigh_lines(step: float | Array) -> tuple[Array, Array, Array]:
    """The same where the input goes straight from sample to sample, and is seen all the time."""
    kept = np.exp(-np.asarray(step))
    mean = (1.0 - kept) / step
    return kept, mean - kept, 1.0 - mean


def _lag(x: Array, first: Array, kept: Array, before: Array, now: Array) -> Array:
    """y_k = kept y_{k-1} + before x_{k-1} + now x_k, from y_0 = first (..., c) on.

    Weights of all samples alike, or of each but the first (n-1,).
    """
    if kept.ndim:
        return _lag_unevenly(x, first, kept, before, now)
    begin = (kept * first + before * x[..., 0, :])[..., None, :]
    b, a = np.stack([now, before]), np.stack([np.ones_like(kept), -kept])
    y, _ = scipy.signal.lfilter(b, a, x[..., 1:, :], axis=-2, zi=begin)
    return np.concatenate([first[..., None, :], y], axis=-2)


def _lag_unevenly(x: Array, first: Array, kept: Array, before: Array, now: Array) -> Array:
    y = np.empty_like(x)
    y[..., 0, :] = first
    for k in range(len(kept)):
        y[..., k + 1, :] = (
            kept[k] * y[..., k, :] + before[k] * x[..., k, :] + now[k] * x[..., k + 1, :]
        )
    return y


def _delayed(y: Array) -> Array:
    """Each sample's predecessor (n, c); that of the first on a straight line."""
    return np.concatenate([2.0 * y[:1] - y[1:2], y[:-1]]) if len(y) > 1 else y


def in_world(eta: Array, nu: Array, nu_dot: Array | None = None) -> Array:
    """Channels (..., 14), or (..., 21) with accelerations: poses and derivatives in world axes.

    p' = R v, q' = q omega / 2 (Fossen 2021, eq. 2.78), and their derivatives.
    """
    q, v, omega = eta[..., 3:7], nu[..., :3], nu[..., 3:]
    q_dot = 0.5 * multiply(q, _pure(omega))
    found = [eta[..., :7], rotate(q, v), q_dot]
    if nu_dot is not None:
        v_dot = nu_dot[..., :3] + np.cross(omega, v)
        q_ddot = 0.5 * (multiply(q_dot, _pure(omega)) + multiply(q, _pure(nu_dot[..., 3:])))
        found += [rotate(q, v_dot), q_ddot]
    return np.concatenate(found, axis=-1)


def in_body(channels: Array) -> tuple[Array, ...]:
    """Poses (..., 7), velocities (..., 6) and, of 21 channels, accelerations, all in body axes.

    The inverse of `in_world`; a quaternion that a filter made shorter is stretched again.
    """
    length = np.linalg.norm(channels[..., 3:7], axis=-1, keepdims=True)
    q, q_dot = channels[..., 3:7] / length, channels[..., 10:14] / length
    eta = np.concatenate([channels[..., :3], q], axis=-1)
    v, omega = unrotate(q, channels[..., 7:10]), body_rates(q, q_dot)
    nu = np.concatenate([v, omega], axis=-1)
    if channels.shape[-1] == 14:
        return eta, nu
    v_dot = unrotate(q, channels[..., 14:17]) - np.cross(omega, v)
    # of a length r that changes: q'' of the unit quaternion lacks 2 (r'/r) q'
    growth = np.sum(q * q_dot, axis=-1, keepdims=True)
    omega_dot = body_rate_derivative(q, channels[..., 17:21] / length) - 2.0 * growth * omega
    return eta, nu, np.concatenate([v_dot, omega_dot], axis=-1)


def unit(eta: Array) -> Array:
    """Poses (..., 7) whose quaternion a filter made shorter."""
    return np.concatenate([eta[..., :3], normalized(eta[..., 3:7])], axis=-1)


def _pure(x: Array) -> Array:
    """Quaternions (..., 4) without a real part."""
    return np.concatenate([np.zeros_like(x[..., :1]), x], axis=-1)
