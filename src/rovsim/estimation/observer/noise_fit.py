"""The most likely noise of innovations, axis by axis."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize

from rovsim.core.threads import map_on_cores
from rovsim.estimation.kernels.axis import misfit
from rovsim.estimation.observer.kalman import (
    TYPICAL_BIAS_TIME,
    AxisErrorDynamics,
    AxisFilter,
    AxisNoise,
)
from rovsim.estimation.observer.noise import Noise, RunFilters
from rovsim.estimation.observer.observed_run import ObservedRun

# Eddies as large as the vehicle (0.2 to 0.5 m) pass it within 0.3 to 3 s at 0.15 to 0.7 m/s.
# A longer one would let the disturbance swallow a steady force, which is a missing effect.
MIN_CORRELATION_TIME, TYPICAL_CORRELATION_TIME, MAX_CORRELATION_TIME = 0.2, 1.0, 3.0  # s
CORRELATION_TIME_LOG_STD = 0.7  # of log T: a factor of two either way


# A slow error of calibrated cameras is no larger than their noise from frame to frame.
BIAS_TIME_LOG_STD = 0.7  # of its correlation time: a factor of two either way
MIN_VARIANCE = 1e-12  # of the variance at first: an axis on which nothing at all happens
# Of the descent, in the logarithms of a noise and in its log likelihood: no choice hangs on less.
INITIAL_STEP, LOG_NOISE_TOLERANCE, LOG_LIKELIHOOD_TOLERANCE, MAX_STEPS = 0.3, 0.01, 0.02, 300
MIN_LR_OF_BIAS = 12.0  # two more numbers, and sure of it on six axes


class NoiseFit(NamedTuple):
    """The most likely noise, and twice the log likelihood under it, up to a constant."""

    noise: Noise
    two_log_likelihood: float


def fit_noise(
    e: Sequence[Array],
    runs: Sequence[ObservedRun],
    made_by: Sequence[RunFilters],
    error_dynamics: Sequence[AxisErrorDynamics],
    start: Noise,
    with_bias: bool = False,
    draws: int = 1,
) -> NoiseFit:
    """Fit the noise to innovations by maximum likelihood, each axis by itself.

    The correlation time has a prior: that of turbulence is about a second, within a factor of two.

    Args:
        e: innovations (6, n_run) of each run.
        runs: the runs.
        made_by: the filters of each run that its innovations come from.
        error_dynamics: how an error of the model grows or decays on each of the six axes.
        start: where the fit begins. An axis that no reading shows keeps this noise.
        with_bias: whether to look for slow errors of the readings; else they stay as in `start`.
        draws: how many sets of innovations `e` holds, each of which might be the true one. All sets
            together then count as one.
    """

    def of_axis(i: int, dynamics: AxisErrorDynamics) -> tuple[AxisNoise, float]:
        filters = tuple(x.filters[i] for x in made_by)
        e_axis = tuple(x[i] for x in e)
        axis = _AxisInnovations(i, e_axis, tuple(runs), filters, dynamics, draws)
        if not axis.counted:
            return start.of_axis(i), 0.0
        noise, cost = _fit_axis(axis, start.of_axis(i))
        return _fit_bias(axis, noise, cost) if with_bias and not axis.binned else (noise, cost)

    noises, costs = zip(
        *map_on_cores(of_axis, range(len(error_dynamics)), error_dynamics), strict=True
    )
    return NoiseFit(Noise(*np.array(noises).T), -2.0 * sum(costs))


class _Misfit(NamedTuple):
    """Sums over innovations: of their squares over their variance, and of its logarithm.

    `shown` is the number of innovations that count.
    """

    squares: float
    logs: float
    shown: float


@dataclass(frozen=True, eq=False)
class _AxisInnovations:
    """Innovations of one axis, with all that their likelihood needs besides the noise.

    Attributes:
        axis: its number, 0 to 5.
        e: innovations (n_run,) of each run.
        runs: the runs.
        filters: of each run, that its innovations come from.
        dynamics: how an error of the model grows or decays on this axis.
        draws: how many sets of innovations there are; they count as one.
    """

    axis: int
    e: tuple[Array, ...]
    runs: tuple[ObservedRun, ...]
    filters: tuple[AxisFilter, ...]
    dynamics: AxisErrorDynamics
    draws: int

    @property
    def counted(self) -> bool:
        """Whether any innovation counts."""
        return any((run.settled & run.innovation_mask[:, self.axis]).any() for run in self.runs)

    @property
    def binned(self) -> bool:
        """Whether velocities of bins were read."""
        return self.runs[0].motion.binned

    @property
    def single(self) -> float:
        """How many times noisier a single frame is than a reading, which is a mean of frames."""
        return float(np.sqrt(self.runs[0].group))

    def cost(self, noise: AxisNoise) -> float:
        """Negative log likelihood of a noise, up to a constant; infinite where it is undefined."""
        sums = self._misfit(noise)
        return _finite(0.5 * (sums.squares + sums.logs) / self.draws)

    def scaled(self, noise: AxisNoise) -> tuple[AxisNoise, float]:
        """The likeliest multiple of a noise without a slow error, and its negative log likelihood.

        The multiple follows without a search: the variance of the innovations is proportional to
        that of the noise.
        """
        squares, logs, count = self._misfit(noise)
        size = max(squares / count, MIN_VARIANCE)
        cost = _finite(0.5 * (squares / size + count * np.log(size) + logs) / self.draws)
        by = float(np.sqrt(size))
        disturbance_std, measurement_std = by * noise.disturbance_std, by * noise.measurement_std
        scaled = noise._replace(disturbance_std=disturbance_std, measurement_std=measurement_std)
        return scaled, cost

    def _misfit(self, noise: AxisNoise) -> _Misfit:
        """What the likelihood of a noise is made of, summed over all runs."""
        values, squares, logs, count = np.array(noise), 0.0, 0.0, 0.0
        for run_data in self._kernel_arguments:
            square, log, n = misfit(values, *run_data)
            squares, logs, count = squares + square, logs + n * log, count + n
        return _Misfit(squares, logs, count)

    @cached_property
    def _kernel_arguments(self) -> list[tuple]:
        """Arguments of the kernel `misfit` for each run, without the noise."""
        inputs = zip(self.e, self.runs, self.filters, strict=True)
        return [self._of_run(run, made_by, e) for e, run, made_by in inputs]

    def _of_run(self, run: ObservedRun, old: AxisFilter, e: Array) -> tuple:
        i, kind, h = self.axis, run.reading_kinds[self.axis], float(run.axis_periods[self.axis])
        return (
            kind,
            h,
            self.dynamics.over(h, kind),
            old.denominator,
            old.noise_denominator,
            e,
            run.innovation_segments,
            run.settled,
            run.innovation_mask[:, i],
        )


def _fit_axis(axis: _AxisInnovations, start: AxisNoise) -> tuple[AxisNoise, float]:
    """The likeliest noise of one axis, with the slow error of `start`, and its cost."""
    if start.bias_std == 0.0:
        return _fit_white(axis, start)

    def at(x: Array) -> AxisNoise:
        std, lasts, error = np.exp(x)
        return start._replace(disturbance_std=std, correlation_time=lasts, measurement_std=error)

    x, least_cost = _descend(lambda x: _cost(axis, at(x)), np.log(start[:3]))
    return at(x), least_cost


def _fit_white(axis: _AxisInnovations, start: AxisNoise) -> tuple[AxisNoise, float]:
    """The likeliest noise of one axis without a slow error, and its cost.

    Only the correlation time and the ratio of disturbance to noise are searched for; the size of
    both follows from them.
    """

    def at(x: Array) -> tuple[AxisNoise, float]:
        correlation_time, ratio = np.exp(x)
        std = ratio * start.measurement_std
        noise = start._replace(disturbance_std=std, correlation_time=correlation_time)
        scaled, cost = axis.scaled(noise)
        return scaled, _correlation_time_prior(correlation_time) + cost

    guess = np.log([start.correlation_time, start.disturbance_std / start.measurement_std])
    x, least_cost = _descend(lambda x: at(x)[1], guess)
    return at(x)[0], least_cost


def _fit_bias(
    axis: _AxisInnovations, white: AxisNoise, white_cost: float
) -> tuple[AxisNoise, float]:
    """The noise of one axis with a slow error of the readings, if that is surely more likely.

    Args:
        axis: the innovations.
        white: the noise so far, with which the fit begins.
        white_cost: its cost.

    Returns:
        The likelier noise, and its cost.
    """

    def cost(x: Array) -> float:
        return _cost(axis, AxisNoise(*np.exp(x)))

    guess = white._replace(bias_std=white.measurement_std, bias_correlation_time=TYPICAL_BIAS_TIME)
    x0 = white if white.bias_std else guess
    x, least_cost = _descend(cost, np.log(x0))
    if white.bias_std:
        white, white_cost = _fit_axis(axis, white._replace(bias_std=0.0))
    if 2.0 * (white_cost - least_cost) < MIN_LR_OF_BIAS:
        return white, white_cost
    return AxisNoise(*np.exp(x)), least_cost


def _cost(axis: _AxisInnovations, noise: AxisNoise) -> float:
    """Negative log posterior of a noise, up to a constant: its likelihood and its priors."""
    prior = _correlation_time_prior(noise.correlation_time) + _bias_prior(noise, axis.single)
    return prior + axis.cost(noise)


def _finite(cost: float) -> float:
    return float(cost) if np.isfinite(cost) else np.inf


def _descend(cost: Callable[[Array], float], first: Array) -> tuple[Array, float]:
    """Minimise a cost from a first point (k,): the best point, and its cost."""
    simplex = first + np.vstack([np.zeros(len(first)), INITIAL_STEP * np.eye(len(first))])
    minimum = minimize(
        cost,
        first,
        method="Nelder-Mead",
        options={
            "initial_simplex": simplex,
            "xatol": LOG_NOISE_TOLERANCE,
            "fatol": LOG_LIKELIHOOD_TOLERANCE,
            "maxiter": MAX_STEPS,
        },
    )
    return minimum.x, float(minimum.fun)


def _correlation_time_prior(time: float) -> float:
    """Negative log prior of a correlation time, s; steep beyond the range that eddies can have."""
    excess = max(0.0, time / MAX_CORRELATION_TIME - 1.0)
    excess += max(0.0, MIN_CORRELATION_TIME / time - 1.0)
    log = np.log(time / TYPICAL_CORRELATION_TIME)
    return 0.5 * (log / CORRELATION_TIME_LOG_STD) ** 2 + 1e3 * excess


def _bias_prior(noise: AxisNoise, single: float) -> float:
    """Negative log prior of a slow error of the readings; 0 where there is none.

    `single`: how many times noisier a single frame is than a reading.
    """
    if noise.bias_std == 0.0:
        return 0.0
    log_ratio = np.log(noise.bias_correlation_time / TYPICAL_BIAS_TIME) / BIAS_TIME_LOG_STD
    return 0.5 * float(log_ratio**2 + (noise.bias_std / (single * noise.measurement_std)) ** 2)
