"""The most likely noise of innovations, axis by axis."""

from dataclasses import dataclass
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize

from rovsim.diagnosis.observer.kalman import AxisFilter, AxisNoise, design_filter, sum_of_squares
from rovsim.diagnosis.observer.noise import Noise, Tuning
from rovsim.diagnosis.observer.observed_run import ObservedRun

# Eddies as large as the vehicle (0.2 to 0.5 m) pass it within 0.3 to 3 s at 0.15 to 0.7 m/s.
# Longer memory would let the disturbance swallow a steady force, which is a missing effect.
SHORTEST_MEMORY, TYPICAL_MEMORY, LONGEST_MEMORY = 0.2, 1.0, 3.0  # s
MEMORY_SPREAD = 0.7  # of log T: a factor of two either way


class NoiseFit(NamedTuple):
    """The most likely noise, and twice the log likelihood under it, up to a constant."""

    noise: Noise
    likelihood: float


def fit_noise(
    e: Sequence[Array],
    runs: Sequence[ObservedRun],
    found: Sequence[Tuning],
    damping: Array,
    start: Noise,
) -> NoiseFit:
    """The most likely noise of innovations e (6, n_run).

    The memory has a prior: turbulence remembers about a second, within a factor of two.

    Args:
        e: innovations of each run.
        runs: the runs.
        found: the tuning each was found with.
        damping: decay (6,) of the velocities, 1/s.
        start: where to begin.
    """
    noises, costs = [], []
    for i, d in enumerate(damping):
        filters = tuple(one.filters[i] for one in found)
        axis = _AxisInnovations(tuple(one[i] for one in e), tuple(runs), filters, d)
        noise, cost = _fit_axis(axis, start.of_axis(i))
        noises.append(noise)
        costs.append(cost)
    return NoiseFit(Noise(*np.array(noises).T), -2.0 * sum(costs))


@dataclass(frozen=True, eq=False)
class _AxisInnovations:
    """Innovations (n_run,) of one axis, and the filter of each run they were found with."""

    e: tuple[Array, ...]
    runs: tuple[ObservedRun, ...]
    filters: tuple[AxisFilter, ...]
    damping: float

    def cost(self, noise: AxisNoise) -> float:
        """Negative log likelihood of a noise, up to a constant."""
        new = {
            run.period: design_filter(run.motion.binned, run.period, self.damping, noise)
            for run in self.runs
        }
        each = zip(self.e, self.runs, self.filters, strict=True)
        return sum(_run_cost(e, run, old, new[run.period]) for e, run, old in each)


def _run_cost(e: Array, run: ObservedRun, old: AxisFilter, new: AxisFilter) -> float:
    squares, count = sum_of_squares(*new.whitening(old), e, run.rows, run.settled)
    return 0.5 * float(squares / new.variance + count * np.log(new.variance))


def _fit_axis(axis: _AxisInnovations, start: AxisNoise) -> tuple[Array, float]:
    """Level, memory and reading noise (3,) of one axis, and what they cost."""

    def cost(x: Array) -> float:
        noise = AxisNoise(*np.exp(x))
        return _memory_prior(noise.memory) + axis.cost(noise)

    first = np.log(start)
    simplex = first + np.vstack([np.zeros(3), 0.3 * np.eye(3)])
    best = minimize(
        cost, first, method="Nelder-Mead",
        options={"initial_simplex": simplex, "xatol": 0.01, "fatol": 0.02, "maxiter": 300},
    )  # fmt: skip
    return np.exp(best.x), float(best.fun)


def _memory_prior(memory: float) -> float:
    """Negative log of the prior of a memory, s; steep outside of what eddies can do."""
    outside = max(0.0, memory / LONGEST_MEMORY - 1.0) + max(0.0, SHORTEST_MEMORY / memory - 1.0)
    return 0.5 * (np.log(memory / TYPICAL_MEMORY) / MEMORY_SPREAD) ** 2 + 1e3 * outside
