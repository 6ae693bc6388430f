"""What no model predicts, axis by axis: a disturbance that lasts, and noise of the readings.

The errors of a model are themselves modelled as a linear system. Its states are the error of the
pose p and of the velocity v, and the disturbance a (an acceleration). A reading is of one kind:

    pose      x = (p, v, a):  p' = v,  v' = -d v - k p + a,  a' = -a / T + white noise
              p is read, with white noise
              if cameras err slowly, also b' = -b / T_b + white noise, and p + b is read
    velocity  x = (v, a):     the same without p; v (its mean over a bin) is read, with white noise
    sum       as pose, where p is the sum of measured velocities: their noise adds up in p itself

The steady-state Kalman filter of this linear system corrects the nonlinear model
(engine/observer.py). If the noise is right, its innovations are white with a known variance.
A rational filter turns the innovations of one noise into those of another. So the noise can be
fitted, and candidates can be compared, without running the model again.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.threads import on_cores
from rovsim.estimation.kernels.axis import filter_kept
from rovsim.estimation.observer.autoregression import Autoregression
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
    """The current over one run.

    Attributes:
        time: of the readings (n,), s.
        current: north and east (n, 2), m/s.
    """

    time: Array
    current: Array

    def at(self, time: Array) -> Array:
        """The current (k, 2) m/s at other times (k,) s; constant beyond the first and the last."""
        return np.column_stack([np.interp(time, self.time, c) for c in self.current.T])


class DriftingCurrent(NamedTuple):
    """A current that is a random walk.

    Attributes:
        rate: of the walk, m/s per sqrt(s).
        paths: the likeliest current of each run; empty where the model is linearised about still
            water.
    """

    rate: float
    paths: tuple[CurrentPath, ...] = ()


@dataclass(frozen=True, eq=False)
class Noise:
    """The disturbance and the noise of the readings, (6,) each for surge to yaw.

    Attributes:
        disturbance_std: of the disturbance, m/s2 and rad/s2.
        correlation_time: of the disturbance, s.
        measurement_std: of the white noise of the readings, in their units (m, rad, or per s).
        bias_std: of a slow error of the readings, in their units; 0 where there is none.
        bias_correlation_time: of that error, s.
        autoregression: how innovations predict one another, where axes drive each other.
        drift: of the current, where it wanders.
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

    def of_runs(self, places: Sequence[int]) -> "Noise":
        """The same noise of some of the runs only: a current that wanders has a path in each."""
        if self.drift is None or not self.drift.paths:
            return self
        paths = tuple(self.drift.paths[k] for k in places)
        return replace(self, drift=self.drift._replace(paths=paths))

    def draws(self, run: ObservedRun, random: np.random.Generator) -> NoiseDraws:
        """The same noise as a generator of random errors at the readings of a run."""
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
        """The same without slow errors of the readings: the noise that the filters are made for."""
        return replace(self, bias_std=np.zeros(6))


# Turbulence that moves this vehicle by some mm/s2, and a usual motion capture: only a first guess.
FIRST_NOISE = Noise(
    np.array([0.02] * 3 + [0.05] * 3), np.ones(6), np.array([1e-3] * 3 + [3e-3] * 3)
)


@dataclass(frozen=True, eq=False)
class RunFilters:
    """The filters of the six axes for one run.

    Attributes:
        filters: one for each axis, surge to yaw.
        periods: mean time (6,) between two readings of each axis, s.
        steps: how long each integration step (s,) of the run takes, s.
    """

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
        """Share of the disturbance (s, 6) that remains after each of the run's steps."""
        return self.decay(self.steps)

    def decay(self, h: Array) -> Array:
        """Share of the disturbance (s, 6) that remains after times `h` (s,) s."""
        return np.array([f.decay for f in self.filters]) ** (h[:, None] / self.periods)

    @property
    def variance(self) -> Array:
        """Variance (6,) of the innovations."""
        return np.array([f.variance for f in self.filters])


def design_filters(
    noise: Noise, error_dynamics: Sequence[AxisErrorDynamics], run: ObservedRun
) -> RunFilters:
    """Design the filters of the six axes for one noise and one run.

    Args:
        noise: of the six axes.
        error_dynamics: how an error of the model grows or decays on each of the six axes.
        run: whose readings are filtered.
    """
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
    suited: Sequence[RunFilters],
) -> Array:
    """Turn innovations of some filters into those of others, scaled to unit variance.

    They are white if `suited` suit the noise. Innovations from before the filters had settled are
    left out.

    Args:
        e: innovations (..., 6, n_run) of each run.
        runs: the runs.
        made_by: the filters of each run that the innovations come from.
        suited: the filters of each run whose innovations are wanted.

    Returns:
        Those (..., 6, n) of all runs, one run after the other.
    """
    return np.concatenate(
        [whiten_run(*inputs) for inputs in zip(e, runs, made_by, suited, strict=True)], axis=-1
    )


def whiten_run(e: Array, run: ObservedRun, made_by: RunFilters, suited: RunFilters) -> Array:
    """As `whiten`, for innovations (..., 6, n) of one run, of which m are settled: (..., 6, m)."""
    pairs = zip(suited.filters, made_by.filters, strict=True)
    b, a = map(_stack, zip(*(new.whitening(old) for new, old in pairs), strict=True))
    rows = e.reshape(int(np.prod(e.shape[:-2])), *e.shape[-2:])
    out = np.empty((*rows.shape[:-1], int(run.settled.sum())), e.dtype)
    scale = 1.0 / np.sqrt(suited.variance)
    on_cores(
        lambda k: filter_kept(
            b, a, rows[k], run.innovation_segments, run.settled, run.innovation_mask, scale, out[k]
        ),
        np.ones(len(rows)),
    )
    return out.reshape(*e.shape[:-1], out.shape[-1])


def _stack(polynomials: Sequence[Array]) -> Array:
    """Polynomials in the delay operator as the rows of one array, padded with zeros at the end."""
    rows = np.zeros((len(polynomials), max(len(polynomial) for polynomial in polynomials)))
    for row, polynomial in zip(rows, polynomials, strict=True):
        row[: len(polynomial)] = polynomial
    return rows
