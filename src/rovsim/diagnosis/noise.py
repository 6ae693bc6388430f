"""What no model predicts: noise of the readings, and a disturbance with memory. Per axis.

    pose      x = (p, v, a):  p' = v,  v' = -d v + a,  a' = -a / T + white noise,  reading p + noise
    velocity  x = (v, a):     the same without p,      reading v (mean over the bin) + noise

The steady-state Kalman filter of this linear model corrects the nonlinear one (engine/observer.py),
and its innovations, if the noise is right, are white with a known variance. Innovations found with
one noise are turned into those of another by a rational filter, so the noise can be fitted, and
candidates be compared, without observing anew.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize
from scipy.signal import lfilter

from rovsim import AXES
from rovsim.diagnosis.watch import Watch
from rovsim.model import Model

# Eddies as large as the vehicle (0.2 to 0.5 m) pass it within 0.3 to 3 s at 0.15 to 0.7 m/s.
# Longer memory would let the disturbance swallow a steady force, which is a missing effect.
SHORTEST_MEMORY, TYPICAL_MEMORY, LONGEST_MEMORY = 0.2, 1.0, 3.0  # s
MOST_DOUBLINGS = 60
MEMORY_SPREAD = 0.7  # of log T: a factor of two either way


@dataclass(frozen=True, eq=False)
class Noise:
    """Per axis (6,): `level` m/s2 or rad/s2 and `memory` s of the disturbance, `reading` noise."""

    level: Array
    memory: Array
    reading: Array


@dataclass(frozen=True, eq=False)
class AxisFilter:
    """Steady-state Kalman filter of one axis: `F` (n, n), `C`, `gain` (n,), innovation variance."""

    F: Array
    C: Array
    gain: Array
    variance: float

    @cached_property
    def poles(self) -> Array:
        """Characteristic polynomial of the filter."""
        return characteristic(self.F @ (np.eye(len(self.C)) - np.outer(self.gain, self.C)))

    @property
    def decay(self) -> float:
        """What remains of the disturbance after one period."""
        return float(self.F[-1, -1])

    def whitening(self, old: "AxisFilter") -> tuple[Array, Array]:
        """Rational filter (b, a) that turns innovations of the filter `old` into this one's."""
        b = np.convolve([1.0, -self.decay], old.poles)
        return b, np.convolve([1.0, -old.decay], self.poles)


@dataclass(frozen=True, eq=False)
class Tuning:
    """One filter an axis, for one noise and one damping."""

    filters: tuple[AxisFilter, ...]
    period: float

    @property
    def gains(self) -> Array:
        """Corrections (3, 6) of pose, velocity and disturbance per unit of innovation."""
        rows = [np.concatenate([np.zeros(3 - len(f.gain)), f.gain]) for f in self.filters]
        return np.ascontiguousarray(np.array(rows).T)

    def decay(self, h: float) -> Array:
        """What remains of the disturbance (6,) after h s."""
        return np.array([f.decay for f in self.filters]) ** (h / self.period)

    @property
    def variance(self) -> Array:
        """Variance (6,) of the innovations."""
        return np.array([f.variance for f in self.filters])


def damping_rates(model: Model, watches: Sequence[Watch]) -> Array:
    """How fast each velocity decays (6,) 1/s at the speeds of the runs."""
    nu = np.concatenate([w.motion.nu[w.motion.usable] for w in watches])
    body = model.body
    return (body.linear + 2.0 * body.quadratic * np.mean(np.abs(nu), axis=0)) / np.diag(body.M)


def tuning(noise: Noise, damping: Array, watch: Watch) -> Tuning:
    """The filters for one noise."""
    found = [
        _axis_filter(watch, damping[i], noise.level[i], noise.memory[i], noise.reading[i])
        for i in range(6)
    ]
    return Tuning(tuple(found), watch.period)


def _axis_filter(watch: Watch, d: float, level: float, memory: float, reading: float) -> AxisFilter:
    make = _velocity_filter if watch.motion.binned else _pose_filter
    return make(watch.period, d, level, memory, reading)


def _pose_filter(h: float, d: float, level: float, memory: float, reading: float) -> AxisFilter:
    phi = np.exp(-h / memory)
    F = np.array([[1.0, h, 0.5 * h * h], [0.0, 1.0 - d * h, h], [0.0, 0.0, phi]])
    return _steady(F, np.array([1.0, 0.0, 0.0]), level**2 * (1.0 - phi**2), reading)


def _velocity_filter(h: float, d: float, level: float, memory: float, reading: float) -> AxisFilter:
    phi = np.exp(-h / memory)
    fade = np.exp(-d * h)
    F = np.array([[fade, h], [0.0, phi]])
    # the mean over a bin is the velocity at its middle
    return _steady(F, np.array([1.0, -0.5 * h]), level**2 * (1.0 - phi**2), reading)


def _steady(F: Array, C: Array, driving: float, reading: float) -> AxisFilter:
    # A little noise everywhere keeps the Riccati equation solvable; it is far below the readings'.
    Q = np.diag([1e-6 * reading**2] * (len(C) - 1) + [driving + 1e-12])
    P = riccati(F, C, Q, reading**2)
    variance = float(C @ P @ C) + reading**2
    return AxisFilter(F, C, P @ C / variance, variance)


def riccati(F: Array, C: Array, Q: Array, r: float) -> Array:
    """Steady covariance (n, n) of x' = F x + w, y = C x + v, predicted; w has Q, v has variance r.

    By structure-preserving doubling (Chu, Fan, Lin & Wang 2004): ten times faster on matrices this
    small than the general solver, with which a test compares it.
    """
    A, G, H, unit = F.T, np.outer(C, C) / r, Q, np.eye(len(C))
    for _ in range(MOST_DOUBLINGS):
        W = np.linalg.inv(unit + G @ H)
        more = A.T @ H @ W @ A
        A, G, H = A @ W @ A, G + A @ W @ G @ A.T, H + more
        if np.max(np.abs(more)) <= 1e-13 * np.max(np.abs(H)):
            break
    return H


def characteristic(A: Array) -> Array:
    """Coefficients of det(z I - A), highest power first (Faddeev-LeVerrier)."""
    found, M = [1.0], np.zeros_like(A)
    for k in range(1, len(A) + 1):
        M = A @ M + found[-1] * np.eye(len(A))
        found.append(-np.trace(A @ M) / k)
    return np.array(found)


def filtered(b: Array, a: Array, e: Array, rows: Sequence[tuple[int, int]]) -> Array:
    """Filter e (..., n) along its last axis, each span by itself."""
    out = np.empty_like(e)
    for first, last in rows:
        out[..., first:last] = lfilter(b, a, e[..., first:last], axis=-1)
    return out


def whitened(
    e: Sequence[Array], watches: Sequence[Watch], found: Sequence[Tuning], wanted: Sequence[Tuning]
) -> Array:
    """Innovations of unit variance (..., 6, n) of all runs, those not settled left out.

    Args:
        e: innovations (..., 6, n_run) of each run.
        watches: the runs.
        found: the tuning each was found with.
        wanted: the tuning that should make them white.
    """
    return np.concatenate(
        [_white_run(*one) for one in zip(e, watches, found, wanted, strict=True)], axis=-1
    )


def _white_run(e: Array, watch: Watch, found: Tuning, wanted: Tuning) -> Array:
    axes = [
        filtered(*new.whitening(old), e[..., i, :], watch.rows)[..., watch.settled]
        for i, (new, old) in enumerate(zip(wanted.filters, found.filters, strict=True))
    ]
    return np.stack(axes, axis=-2) / np.sqrt(wanted.variance)[:, None]


def fit_noise(
    e: Sequence[Array],
    watches: Sequence[Watch],
    found: Sequence[Tuning],
    damping: Array,
    start: Noise,
) -> tuple[Noise, float]:
    """The most likely noise of innovations e (6, n_run), and twice the log likelihood.

    The memory has a prior: turbulence remembers about a second, within a factor of two.
    """
    fitted = [_fit_axis(i, e, watches, found, damping, start) for i in range(len(AXES))]
    level, memory, reading = np.array([f[0] for f in fitted]).T
    return Noise(level, memory, reading), -2.0 * sum(f[1] for f in fitted)


def _fit_axis(i, e, watches, found, damping, start) -> tuple[Array, float]:
    def cost(x: Array) -> float:
        level, memory, reading = np.exp(x)
        outside = max(0.0, memory / LONGEST_MEMORY - 1.0) + max(0.0, SHORTEST_MEMORY / memory - 1.0)
        prior = 0.5 * (np.log(memory / TYPICAL_MEMORY) / MEMORY_SPREAD) ** 2 + 1e3 * outside
        new = {w.period: _axis_filter(w, damping[i], level, memory, reading) for w in watches}
        return prior + sum(
            _unlikely(one[i], watch, old.filters[i], new[watch.period])
            for one, watch, old in zip(e, watches, found, strict=True)
        )

    first = np.log([start.level[i], start.memory[i], start.reading[i]])
    simplex = first + np.vstack([np.zeros(3), 0.3 * np.eye(3)])
    best = minimize(
        cost, first, method="Nelder-Mead",
        options={"initial_simplex": simplex, "xatol": 0.01, "fatol": 0.02, "maxiter": 300},
    )  # fmt: skip
    return np.exp(best.x), float(best.fun)


def _unlikely(e: Array, watch: Watch, old: AxisFilter, new: AxisFilter) -> float:
    """Negative log likelihood of one axis (n,) of one run, up to a constant."""
    white = filtered(*new.whitening(old), e, watch.rows)[watch.settled]
    return 0.5 * float(white @ white / new.variance + len(white) * np.log(new.variance))
