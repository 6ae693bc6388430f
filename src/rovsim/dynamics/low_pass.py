"""Low-passes by which a motion capture smooths the poses it reports, and their inverse.

A linear filter acts on a pose and on its derivatives in the same way. So all are filtered as
channels (..., 7 k): a pose (position m, quaternion), its first derivative, …, in world axes.
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
    """First-order low-passes in series ("stages"), by their `time_constants`, s.

    In discrete time: y_k = a y_{k-1} + (1 - a) x_k with a = exp(-dt / T), which delays slow motions
    by a dt / (1 - a), about T - dt / 2.
    """

    time_constants: tuple[float, ...] = ()

    def smooth(
        self, x: Array, dt: float | Array, first: Array | None = None, straight: bool = False
    ) -> Array:
        """Filter channels; returns the output (..., n, c) of the last stage.

        Args:
            x: (..., n, c) input.
            dt: time between two samples, s: one number or (n-1,).
            first: (stages, ..., c) output of each stage at the first sample; None: as after rest.
            straight: whether the filter runs continuously on straight lines between the samples,
                as if the software had a much higher rate.
        """
        for k, T in enumerate(self.time_constants):
            start = x[..., 0, :] if first is None else first[k]
            x = _lag(x, start, *(_weigh_lines if straight else _weigh_samples)(dt / T))
        return x

    def pass_power(self, frequency: Array, dt: float) -> Array:
        """Power gain (f,) of all stages at each frequency (f,), Hz, for samples dt s apart."""
        a = np.exp(-dt / np.array(self.time_constants))[:, None]
        cosine = np.cos(2.0 * np.pi * frequency * dt)
        return np.asarray(np.prod((1.0 - a) ** 2 / (1.0 - 2.0 * a * cosine + a * a), axis=0))

    def stages(self, y: Array, dt: float) -> Array:
        """Recover the input of the first stage and the outputs of all stages from the last output.

        This is the exact inverse of `smooth`, but for the first two samples, before which the
        output is extrapolated on a straight line.

        Args:
            y: (n, c) output of the last stage.
            dt: time between two samples, s.

        Returns:
            (stages + 1, n, c): the input, then the output of each stage.
        """
        outputs = [y]
        for T in reversed(self.time_constants):
            a = np.exp(-dt / T)
            outputs.append((outputs[-1] - a * _delayed(outputs[-1])) / (1.0 - a))
        return np.stack(outputs[::-1])

    def stages_of_derivatives(self, derivatives: Array) -> Array:
        """Recover the same (stages + 1, d, n, c) from an output and its derivatives (d, n, c).

        x = y + T y', for samples too far apart for `stages`. The derivative after the last one
        given is assumed to be zero.
        """
        outputs = [derivatives]
        for T in reversed(self.time_constants):
            rates = np.concatenate([outputs[-1][1:], np.zeros_like(derivatives[:1])])
            outputs.append(outputs[-1] + T * rates)
        return np.stack(outputs[::-1])


def _weigh_samples(step: float | Array) -> tuple[Array, Array, Array]:
    """Weights of the last output, the last and the present input; `step` in time constants."""
    decay = np.exp(-np.asarray(step))
    return decay, np.zeros_like(decay), 1.0 - decay


def _weigh_lines(step: float | Array) -> tuple[Array, Array, Array]:
    """The same weights for a continuous input on straight lines between the samples."""
    decay = np.exp(-np.asarray(step))
    mean = (1.0 - decay) / step
    return decay, mean - decay, 1.0 - mean


def _lag(x: Array, first: Array, kept: Array, before: Array, now: Array) -> Array:
    """Filter: y_k = kept y_{k-1} + before x_{k-1} + now x_k, with y_0 = first (..., c).

    Weights are numbers for all samples, or (n-1,) for all but the first.
    """
    if kept.ndim:
        return _lag_unevenly(x, first, kept, before, now)
    initial = (kept * first + before * x[..., 0, :])[..., None, :]
    b, a = np.stack([now, before]), np.stack([np.ones_like(kept), -kept])
    y, _ = scipy.signal.lfilter(b, a, x[..., 1:, :], axis=-2, zi=initial)
    return np.concatenate([first[..., None, :], y], axis=-2)


def _lag_unevenly(x: Array, first: Array, kept: Array, before: Array, now: Array) -> Array:
    """Filter as `_lag` does, with weights (n-1,) that differ between samples."""
    y = np.empty_like(x)
    y[..., 0, :] = first
    for k in range(len(kept)):
        y[..., k + 1, :] = (
            kept[k] * y[..., k, :] + before[k] * x[..., k, :] + now[k] * x[..., k + 1, :]
        )
    return y


def _delayed(y: Array) -> Array:
    """The sample before each one (n, c); that of the first is extrapolated linearly."""
    return np.concatenate([2.0 * y[:1] - y[1:2], y[:-1]]) if len(y) > 1 else y


def in_world(eta: Array, nu: Array, nu_dot: Array | None = None) -> Array:
    """Channels (..., 14), or (..., 21) with `nu_dot`: poses and their derivatives in world axes.

    p' = R v, q' = q omega / 2 (Fossen 2021, eq. 2.78), and their derivatives.
    """
    q, v, omega = eta[..., 3:7], nu[..., :3], nu[..., 3:]
    q_dot = 0.5 * multiply(q, _pure(omega))
    channels = [eta[..., :7], rotate(q, v), q_dot]
    if nu_dot is not None:
        v_dot = nu_dot[..., :3] + np.cross(omega, v)
        q_ddot = 0.5 * (multiply(q_dot, _pure(omega)) + multiply(q, _pure(nu_dot[..., 3:])))
        channels += [rotate(q, v_dot), q_ddot]
    return np.concatenate(channels, axis=-1)


def in_body(channels: Array) -> tuple[Array, ...]:
    """Poses (..., 7), nu (..., 6) and, of 21 channels, nu_dot (..., 6): inverse of `in_world`.

    Quaternions, which a filter makes shorter, are normalised.
    """
    length = np.linalg.norm(channels[..., 3:7], axis=-1, keepdims=True)
    q, q_dot = channels[..., 3:7] / length, channels[..., 10:14] / length
    eta = np.concatenate([channels[..., :3], q], axis=-1)
    v, omega = unrotate(q, channels[..., 7:10]), body_rates(q, q_dot)
    nu = np.concatenate([v, omega], axis=-1)
    if channels.shape[-1] == 14:
        return eta, nu
    v_dot = unrotate(q, channels[..., 14:17]) - np.cross(omega, v)
    # the length r of the filtered quaternion changes: subtract 2 (r'/r) q' for the unit quaternion
    growth = np.sum(q * q_dot, axis=-1, keepdims=True)
    omega_dot = body_rate_derivative(q, channels[..., 17:21] / length) - 2.0 * growth * omega
    return eta, nu, np.concatenate([v_dot, omega_dot], axis=-1)


def unit(eta: Array) -> Array:
    """Normalise the quaternions of poses (..., 7), which a filter makes shorter."""
    return np.concatenate([eta[..., :3], normalized(eta[..., 3:7])], axis=-1)


def _pure(x: Array) -> Array:
    """Quaternions (..., 4) with zero real part and these vectors (..., 3)."""
    return np.concatenate([np.zeros_like(x[..., :1]), x], axis=-1)
