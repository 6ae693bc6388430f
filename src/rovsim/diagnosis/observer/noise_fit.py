"""The most likely noise of innovations, axis by axis."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize

from rovsim.diagnosis.observer.axis_kernels import misfit
from rovsim.diagnosis.observer.kalman import AxisFilter, AxisMotion, AxisNoise
from rovsim.diagnosis.observer.noise import Noise, Tuning
from rovsim.diagnosis.observer.observed_run import ObservedRun

# Eddies as large as the vehicle (0.2 to 0.5 m) pass it within 0.3 to 3 s at 0.15 to 0.7 m/s.
# Longer memory would let the disturbance swallow a steady force, which is a missing effect.
SHORTEST_MEMORY, TYPICAL_MEMORY, LONGEST_MEMORY = 0.2, 1.0, 3.0  # s
MEMORY_SPREAD = 0.7  # of log T: a factor of two either way


# A slow error of calibrated cameras is no larger than their noise from frame to frame, and lasts as
# long as the vehicle takes to leave the place where the calibration errs.
TYPICAL_COLOUR, COLOUR_SPREAD = 0.5, 0.7  # s, and of its log
FAINTEST = 1e-12  # of the variance at first: an axis on which nothing at all happens
COLOURED = 12.0  # in twice the log likelihood: two more numbers, and sure of it on six axes


class NoiseFit(NamedTuple):
    """The most likely noise, and 2 log L under it, up to a constant."""

    noise: Noise
    two_log_likelihood: float


def fit_noise(
    e: Sequence[Array],
    runs: Sequence[ObservedRun],
    found: Sequence[Tuning],
    motions: Sequence[AxisMotion],
    start: Noise,
    colour: bool = False,
    draws: int = 1,
) -> NoiseFit:
    """The most likely noise of innovations e (6, n_run).

    The memory has a prior: turbulence remembers about a second, within a factor of two.

    Args:
        e: innovations of each run.
        runs: the runs.
        found: the tuning each was found with.
        motions: how errors of the six axes go on.
        start: where to begin.
        colour: whether to look for slow errors of the readings; if not, they stay.
        draws: how often each run is there, with innovations that might all be its own.
    """
    noises, costs = [], []
    for i, motion in enumerate(motions):
        filters = tuple(one.filters[i] for one in found)
        own = tuple(one[i] for one in e)
        axis = _AxisInnovations(i, own, tuple(runs), filters, motion, draws)
        if not axis.counted:
            noises.append(start.of_axis(i))
            continue
        noise, cost = _fit_axis(axis, start.of_axis(i))
        if colour and not axis.binned:
            noise, cost = _fit_colour(axis, noise, cost)
        noises.append(noise)
        costs.append(cost)
    return NoiseFit(Noise(*np.array(noises).T), -2.0 * sum(costs))


@dataclass(frozen=True, eq=False)
class _AxisInnovations:
    """Innovations (n_run,) of an axis, and the filter of each run they were found with.

    All that is there `draws` times counts once.
    """

    axis: int
    e: tuple[Array, ...]
    runs: tuple[ObservedRun, ...]
    filters: tuple[AxisFilter, ...]
    motion: AxisMotion
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
        """Square root of the number of frames in a reading: how much noisier one frame is."""
        return float(np.sqrt(self.runs[0].group))

    def cost(self, noise: AxisNoise) -> float:
        """Negative log likelihood of a noise, up to a constant; infinite where it has none."""
        squares, logs, _ = self._misfit(noise)
        return _finite(0.5 * (squares + logs) / self.draws)

    def scaled(self, noise: AxisNoise) -> tuple[AxisNoise, float]:
        """The likeliest multiple of a noise without a slow error, and its cost."""
        squares, logs, count = self._misfit(noise)
        size = max(squares / count, FAINTEST)  # of the variance; all of the noise makes it alike
        cost = _finite(0.5 * (squares / size + count * np.log(size) + logs) / self.draws)
        by = float(np.sqrt(size))
        return noise._replace(level=by * noise.level, reading=by * noise.reading), cost

    def _misfit(self, noise: AxisNoise) -> tuple[float, float, float]:
        """Sum of squares over their variance, sum of its logarithm, and how many innovations."""
        values, squares, logs, count = np.array(noise), 0.0, 0.0, 0.0
        for known in self._known:
            own, log, more = misfit(values, *known)
            squares, logs, count = squares + own, logs + more * log, count + more
        return squares, logs, count

    @cached_property
    def _known(self) -> list[tuple]:
        """Of each run all that its likelihood needs, but for the noise."""
        each = zip(self.e, self.runs, self.filters, strict=True)
        return [self._of_run(run, old, e) for e, run, old in each]

    def _of_run(self, run: ObservedRun, old: AxisFilter, e: Array) -> tuple:
        i, kind, h = self.axis, run.reading_kinds[self.axis], float(run.axis_periods[self.axis])
        return (
            kind, h, self.motion.over(h, kind), old.denominator, old.noise_denominator,
            e, run.innovation_segments, run.settled, run.innovation_mask[:, i],
        )  # fmt: skip


def _fit_axis(axis: _AxisInnovations, start: AxisNoise) -> tuple[AxisNoise, float]:
    """The noise of one axis, its slow error as given, and what it costs."""
    if start.colour == 0.0:
        return _fit_white(axis, start)

    def at(x: Array) -> AxisNoise:
        level, memory, reading = np.exp(x)
        return start._replace(level=level, memory=memory, reading=reading)

    x, least = _descend(lambda x: _cost(axis, at(x)), np.log(start[:3]))
    return at(x), least


def _fit_white(axis: _AxisInnovations, start: AxisNoise) -> tuple[AxisNoise, float]:
    """The noise of one axis without a slow error, and what it costs; how large it is, is known."""

    def at(x: Array) -> tuple[AxisNoise, float]:
        memory, ratio = np.exp(x)
        noise = start._replace(level=ratio * start.reading, memory=memory)
        scaled, cost = axis.scaled(noise)
        return scaled, _memory_prior(memory) + cost

    first = np.log([start.memory, start.level / start.reading])
    x, least = _descend(lambda x: at(x)[1], first)
    return at(x)[0], least


def _fit_colour(axis: _AxisInnovations, white: AxisNoise, known: float) -> tuple[AxisNoise, float]:
    """The noise of one axis with a slow error of the readings, where that is more likely."""

    def cost(x: Array) -> float:
        return _cost(axis, AxisNoise(*np.exp(x)))

    first = white if white.colour else white._replace(colour=white.reading, colour_memory=0.5)
    x, least = _descend(cost, np.log(first))
    if white.colour:
        white, known = _fit_axis(axis, white._replace(colour=0.0))
    if 2.0 * (known - least) < COLOURED:
        return white, known
    return AxisNoise(*np.exp(x)), least


def _cost(axis: _AxisInnovations, noise: AxisNoise) -> float:
    """Negative log likelihood of a noise, and of its priors."""
    prior = _memory_prior(noise.memory) + _colour_prior(noise, axis.single)
    return prior + axis.cost(noise)


def _finite(cost: float) -> float:
    return float(cost) if np.isfinite(cost) else np.inf


def _descend(cost: Callable[[Array], float], first: Array) -> tuple[Array, float]:
    """Where a cost is least, and the least."""
    simplex = first + np.vstack([np.zeros(len(first)), 0.3 * np.eye(len(first))])
    best = minimize(
        cost, first, method="Nelder-Mead",
        options={"initial_simplex": simplex, "xatol": 0.01, "fatol": 0.02, "maxiter": 300},
    )  # fmt: skip
    return best.x, float(best.fun)


def _memory_prior(memory: float) -> float:
    """Negative log of the prior of a memory, s; steep outside of what eddies can do."""
    outside = max(0.0, memory / LONGEST_MEMORY - 1.0) + max(0.0, SHORTEST_MEMORY / memory - 1.0)
    return 0.5 * (np.log(memory / TYPICAL_MEMORY) / MEMORY_SPREAD) ** 2 + 1e3 * outside


def _colour_prior(noise: AxisNoise, single: float) -> float:
    """Negative log of the prior of a slow error, if there is one."""
    if noise.colour == 0.0:
        return 0.0
    lasting = np.log(noise.colour_memory / TYPICAL_COLOUR) / COLOUR_SPREAD
    return 0.5 * float(lasting**2 + (noise.colour / (single * noise.reading)) ** 2)
