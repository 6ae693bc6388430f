"""What no model predicts: noise of the readings, and a disturbance that lasts. Per axis.

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

from rovsim.dynamics.engine.parallel import on_cores
from rovsim.estimation.observer.autoregression import Autoregression
from rovsim.estimation.observer.axis_kernels import filter_kept
from rovsim.estimation.observer.kalman import (
    TYPICAL_BIAS_TIME,
    AxisErrorDynamics,
    AxisFilter,
    AxisNoise,
    design_filter,
)
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.simulation.noise_draws import NoiseDraws


class CurrentPath(NamedTuple):
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
    paths: tuple[CurrentPath, ...] = ()


@dataclass(frozen=True, eq=False)
class Noise:
    """Per axis (6,): a disturbance, m/s2 or rad/s2, its `correlation_time`, s, and white noise.

    `bias_std` is that of a slow error of the readings; 0 where there is none.
    `autoregression`: what the axes foretell of each other, where they hang together.
    `drift`: of the current, where it wanders.
    """

    disturbance_std: Array
    correlation_time: Array
    measurement_std: Array
    bias_std: Array = field(default_factory=lambda: np.zeros(6))
    bias_correlation_time: Array = field(default_factory=lambda: np.full(6, TYPICAL_BIAS_TIME))
    autoregression: Autoregression | None = None
    drift: DriftingCurrent | None = None

    def of_axis(self, i: int) -> AxisNoise:
        """The noise of one axis."""
        return AxisNoise(
            self.disturbance_std[i],
            self.correlation_time[i],
            self.measurement_std[i],
            self.bias_std[i],
            self.bias_correlation_time[i],
        )

    def draws(self, run: ObservedRun, random: np.random.Generator) -> NoiseDraws:
        """The same to draw from, of a run."""
        return NoiseDraws(
            self.disturbance_std,
            self.correlation_time,
            self.measurement_std,
            run.period,
            self.bias_std,
            self.bias_correlation_time,
            random,
        )

    @property
    def white(self) -> "Noise":
        """The same without slow errors: what the observer itself corrects for."""
        return replace(self, bias_std=np.zeros(6))


# Turbulence that moves this vehicle by some mm/s2, and a usual motion capture: only a first guess.
FIRST_NOISE = Noise(
    np.array([0.02] * 3 + [0.05] * 3), np.ones(6), np.array([1e-3] * 3 + [3e-3] * 3)
)


@dataclass(frozen=True, eq=False)
class RunFilters:
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


def design_filters(
    noise: Noise, error_dynamics: Sequence[AxisErrorDynamics], run: ObservedRun
) -> RunFilters:
    """The filters of six axes for one noise; errors go on as `error_dynamics` say."""
    kinds, periods = run.reading_kinds, run.axis_periods
    filters = [
        design_filter(kinds[i], float(periods[i]), dynamics, noise.of_axis(i))
        for i, dynamics in enumerate(error_dynamics)
    ]
    return RunFilters(tuple(filters), periods, run.step_lengths)


def whiten(
    e: Sequence[Array],
    runs: Sequence[ObservedRun],
    made_by: Sequence[RunFilters],
    wanted: Sequence[RunFilters],
) -> Array:
    """Innovations of unit variance (..., 6, n) of all runs, those not settled left out.

    Args:
        e: innovations (..., 6, n_run) of each run.
        runs: the runs.
        made_by: the filters that each was made by.
        wanted: the filters that should make them white.
    """
    return np.concatenate(
        [whiten_run(*one) for one in zip(e, runs, made_by, wanted, strict=True)], axis=-1
    )


def whiten_run(e: Array, run: ObservedRun, made_by: RunFilters, wanted: RunFilters) -> Array:
    """The same (..., 6, m) of the innovations (..., 6, n) of one run."""
    pairs = zip(wanted.filters, made_by.filters, strict=True)
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
