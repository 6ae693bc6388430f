"""What no model predicts: noise of the readings, and a disturbance with memory. Per axis.

    pose      x = (p, v, a):  p' = v,  v' = -d v + a,  a' = -a / T + white noise,  reading p + noise
    velocity  x = (v, a):     the same without p,      reading v (mean over the bin) + noise

The steady-state Kalman filter of this linear model corrects the nonlinear one (engine/observer.py),
and its innovations, if the noise is right, are white with a known variance. Innovations found with
one noise are turned into those of another by a rational filter, so the noise can be fitted, and
candidates be compared, without observing anew.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize

from rovsim import AXES
from rovsim.diagnosis.observer.kalman import AxisFilter, axis_filter, filter_kept, sum_of_squares
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.engine.parallel import on_cores

# Eddies as large as the vehicle (0.2 to 0.5 m) pass it within 0.3 to 3 s at 0.15 to 0.7 m/s.
# Longer memory would let the disturbance swallow a steady force, which is a missing effect.
SHORTEST_MEMORY, TYPICAL_MEMORY, LONGEST_MEMORY = 0.2, 1.0, 3.0  # s
MEMORY_SPREAD = 0.7  # of log T: a factor of two either way


@dataclass(frozen=True, eq=False)
class Noise:
    """Per axis (6,): `level` m/s2 or rad/s2 and `memory` s of the disturbance, `reading` noise."""

    level: Array
    memory: Array
    reading: Array


# Turbulence that moves this vehicle by some mm/s2, and a usual motion capture: only a first guess.
FIRST_NOISE = Noise(
    np.array([0.02] * 3 + [0.05] * 3), np.ones(6), np.array([1e-3] * 3 + [3e-3] * 3)
)


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


def tune(noise: Noise, damping: Array, run: ObservedRun) -> Tuning:
    """The filters for one noise."""
    of_axes = zip(damping, noise.level, noise.memory, noise.reading, strict=True)
    found = [axis_filter(run.motion.binned, run.period, *one) for one in of_axes]
    return Tuning(tuple(found), run.period)


def whiten(
    e: Sequence[Array],
    runs: Sequence[ObservedRun],
    found: Sequence[Tuning],
    wanted: Sequence[Tuning],
) -> Array:
    """Innovations of unit variance (..., 6, n) of all runs, those not settled left out.

    Args:
        e: innovations (..., 6, n_run) of each run.
        runs: the runs.
        found: the tuning each was found with.
        wanted: the tuning that should make them white.
    """
    return np.concatenate(
        [_white_run(*one) for one in zip(e, runs, found, wanted, strict=True)], axis=-1
    )


def _white_run(e: Array, run: ObservedRun, found: Tuning, wanted: Tuning) -> Array:
    pairs = zip(wanted.filters, found.filters, strict=True)
    b, a = (np.array(c) for c in zip(*(new.whitening(old) for new, old in pairs), strict=True))
    rows = e.reshape(int(np.prod(e.shape[:-2])), *e.shape[-2:])
    out = np.empty((*rows.shape[:-1], int(run.settled.sum())), e.dtype)
    scale = 1.0 / np.sqrt(wanted.variance)
    on_cores(
        lambda k: filter_kept(b, a, rows[k], run.rows, run.settled, scale, out[k]),
        np.ones(len(rows)),
    )
    return out.reshape(*e.shape[:-1], out.shape[-1])


def fit_noise(
    e: Sequence[Array],
    runs: Sequence[ObservedRun],
    found: Sequence[Tuning],
    damping: Array,
    start: Noise,
) -> tuple[Noise, float]:
    """The most likely noise of innovations e (6, n_run), and twice the log likelihood.

    The memory has a prior: turbulence remembers about a second, within a factor of two.
    """
    fitted = [_fit_axis(i, e, runs, found, damping, start) for i in range(len(AXES))]
    level, memory, reading = np.array([f[0] for f in fitted]).T
    return Noise(level, memory, reading), -2.0 * sum(f[1] for f in fitted)


def _fit_axis(i, e, runs, found, damping, start) -> tuple[Array, float]:
    def cost(x: Array) -> float:
        level, memory, reading = np.exp(x)
        outside = max(0.0, memory / LONGEST_MEMORY - 1.0) + max(0.0, SHORTEST_MEMORY / memory - 1.0)
        prior = 0.5 * (np.log(memory / TYPICAL_MEMORY) / MEMORY_SPREAD) ** 2 + 1e3 * outside
        new = {
            w.period: axis_filter(w.motion.binned, w.period, damping[i], level, memory, reading)
            for w in runs
        }
        return prior + sum(
            _unlikely(one[i], run, old.filters[i], new[run.period])
            for one, run, old in zip(e, runs, found, strict=True)
        )

    first = np.log([start.level[i], start.memory[i], start.reading[i]])
    simplex = first + np.vstack([np.zeros(3), 0.3 * np.eye(3)])
    best = minimize(
        cost, first, method="Nelder-Mead",
        options={"initial_simplex": simplex, "xatol": 0.01, "fatol": 0.02, "maxiter": 300},
    )  # fmt: skip
    return np.exp(best.x), float(best.fun)


def _unlikely(e: Array, run: ObservedRun, old: AxisFilter, new: AxisFilter) -> float:
    """Negative log likelihood of one axis (n,) of one run, up to a constant."""
    squares, count = sum_of_squares(*new.whitening(old), e, run.rows, run.settled)
    return 0.5 * float(squares / new.variance + count * np.log(new.variance))
