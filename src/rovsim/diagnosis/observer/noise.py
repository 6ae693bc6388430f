"""What no model predicts: noise of the readings, and a disturbance with memory. Per axis.

    pose      x = (p, v, a):  p' = v,  v' = -d v - k p + a,  a' = -a / T + white noise
              reading p + noise
              where cameras err slowly, also b' = -b / T_b + white noise, and p + b is read
    velocity  x = (v, a):     the same without p; reading v (mean over the bin) + noise
    sum       as pose, of summed-up velocities: the noise adds up in p, and p is read as it is

The steady-state Kalman filter of this linear model corrects the nonlinear one (engine/observer.py),
and its innovations, if the noise is right, are white with a known variance. Innovations found with
one noise are turned into those of another by a rational filter, so the noise can be fitted, and
candidates be compared, without observing anew.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.autoregression import Autoregression
from rovsim.diagnosis.observer.axis_kernels import filter_kept
from rovsim.diagnosis.observer.kalman import AxisFilter, AxisMotion, AxisNoise, design_filter
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.engine.parallel import on_cores
from rovsim.simulation.noise_draws import NoiseDraws


class Path(NamedTuple):
    """A current (n, 2), north and east in m/s, at the readings of a run (n,) s."""

    time: Array
    current: Array

    def at(self, time: Array) -> Array:
        """The current (k, 2) at other times (k,); before and after as at the ends."""
        return np.column_stack([np.interp(time, self.time, c) for c in self.current.T])


class DriftingCurrent(NamedTuple):
    """A current that wanders by `rate` m/s per sqrt(s), and where it most likely went on each run.

    Without `paths` the water is thought to rest.
    """

    rate: float
    paths: tuple[Path, ...] = ()


@dataclass(frozen=True, eq=False)
class Noise:
    """Per axis (6,): `level` m/s2 or rad/s2 and `memory` s of the disturbance, `reading` noise.

    `colour` is a slow error of the readings, which lasts `colour_memory` s; 0 where there is none.
    `autoregression`: what the axes foretell of each other, where they hang together.
    `drift`: of the current, where it wanders.
    """

    level: Array
    memory: Array
    reading: Array
    colour: Array = field(default_factory=lambda: np.zeros(6))
    colour_memory: Array = field(default_factory=lambda: np.full(6, 0.5))
    autoregression: Autoregression | None = None
    drift: DriftingCurrent | None = None

    def of_axis(self, i: int) -> AxisNoise:
        """The noise of one axis."""
        return AxisNoise(
            self.level[i], self.memory[i], self.reading[i], self.colour[i], self.colour_memory[i]
        )

    def draws(self, run: ObservedRun, random: np.random.Generator) -> NoiseDraws:
        """The same to draw from, of a run."""
        return NoiseDraws(
            self.level, self.memory, self.reading, run.period, self.colour, self.colour_memory,
            random,
        )  # fmt: skip

    @property
    def white(self) -> "Noise":
        """The same without slow errors: what the observer itself corrects for."""
        return replace(self, colour=np.zeros(6))


# Turbulence that moves this vehicle by some mm/s2, and a usual motion capture: only a first guess.
FIRST_NOISE = Noise(
    np.array([0.02] * 3 + [0.05] * 3), np.ones(6), np.array([1e-3] * 3 + [3e-3] * 3)
)


@dataclass(frozen=True, eq=False)
class Tuning:
    """One filter an axis, for one noise and one way to move, and the run's steps (s,) s."""

    filters: tuple[AxisFilter, ...]
    periods: Array
    steps: Array

    @property
    def gains(self) -> Array:
        """Corrections (3, 6) of pose, velocity and disturbance per unit of innovation."""
        rows = [np.concatenate([np.zeros(3 - len(f.gain)), f.gain]) for f in self.filters]
        return np.ascontiguousarray(np.array(rows).T)

    @cached_property
    def decays(self) -> Array:
        """What remains of the disturbance (s, 6) after each of the run's steps."""
        return self.decay(self.steps)

    def decay(self, h: Array) -> Array:
        """What remains of the disturbance (s, 6) after each of h (s,) s."""
        return np.array([f.decay for f in self.filters]) ** (h[:, None] / self.periods)

    @property
    def variance(self) -> Array:
        """Variance (6,) of the innovations."""
        return np.array([f.variance for f in self.filters])


def tune(noise: Noise, motions: Sequence[AxisMotion], run: ObservedRun) -> Tuning:
    """The filters of six axes for one noise; errors go on as `motions` say."""
    kinds, periods = run.reading_kinds, run.axis_periods
    filters = [
        design_filter(kinds[i], float(periods[i]), motion, noise.of_axis(i))
        for i, motion in enumerate(motions)
    ]
    return Tuning(tuple(filters), periods, run.step_lengths)


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
        [whiten_run(*one) for one in zip(e, runs, found, wanted, strict=True)], axis=-1
    )


def whiten_run(e: Array, run: ObservedRun, found: Tuning, wanted: Tuning) -> Array:
    """The same (..., 6, m) of the innovations (..., 6, n) of one run."""
    pairs = zip(wanted.filters, found.filters, strict=True)
    b, a = map(_stack, zip(*(new.whitening(old) for new, old in pairs), strict=True))
    rows = e.reshape(int(np.prod(e.shape[:-2])), *e.shape[-2:])
    out = np.empty((*rows.shape[:-1], int(run.settled.sum())), e.dtype)
    scale = 1.0 / np.sqrt(wanted.variance)
    on_cores(
        lambda k: filter_kept(
            b, a, rows[k], run.innovation_segments, run.settled, run.innovation_mask, scale, out[k]
        ),
        np.ones(len(rows)),
    )
    return out.reshape(*e.shape[:-1], out.shape[-1])


def _stack(polynomials: Sequence[Array]) -> Array:
    """Of the six axes, in powers of the delay: those of lower order end in zeros."""
    found = np.zeros((len(polynomials), max(len(own) for own in polynomials)))
    for row, own in zip(found, polynomials, strict=True):
        row[: len(own)] = own
    return found
