"""What is known before the flight: one hypothesis, or two rivals, as the train runs leave them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy import ndarray as Array

from rovsim.design.low_frequency_disturbance import LowFrequencyDisturbance, estimate_disturbance
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import REACH
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import ObservedRun

RULED_OUT = 1000.0  # to one: a rival with longer odds against it need not be told apart


@dataclass(frozen=True, eq=False)
class FittedHypothesis:
    """A hypothesis as the train runs leave it.

    `information` (k, k) they hold about its scaled parameters, of which those `of_interest` (j,)
    are asked for; `two_log_likelihood` with the penalty of its parameters. `widest`
    has all parameters free with which a rival might take up a flight, `widest_information` (w, w)
    is what they hold about these.
    """

    hypothesis: Hypothesis
    information: Array
    of_interest: Array
    two_log_likelihood: float
    widest: Hypothesis
    widest_information: Array

    @property
    def names(self) -> list[str]:
        """The free parameters, as `effect.parameter`."""
        return self.hypothesis.parameter_names

    @cached_property
    def fixed(self) -> Hypothesis:
        """The same model, in which nothing is free."""
        return Hypothesis(self.hypothesis.model)

    def covariance(self, more: Array | float = 0.0, reach: float = REACH) -> Array:
        """Of the scaled parameters (k, k), with further information (k, k).

        `reach`, in scales: what nobody knows lies within it.
        """
        own = np.eye(len(self.information))
        return solve(self.information + more + own / reach**2, own)

    def std(self, more: Array | float = 0.0) -> Array:
        """Standard deviations (j,) of what is asked for, scaled."""
        return np.sqrt(np.maximum(np.diag(self.covariance(more))[self.of_interest], 1e-300))

    def draw(self, count: int, random: np.random.Generator) -> list[Model]:
        """Models that could be true, the likeliest first; none that cannot move.

        What the runs left open lies within one scale, the size of a change worth looking for.
        """
        h, root = self.hypothesis, _root(self.covariance(reach=1.0))
        found = [h.model]
        while len(found) < count:
            drawn = h.at(h.x + root @ random.normal(size=len(h.x))).model
            found.append(drawn if drawn.possible else h.model)
        return found


def _root(covariance: Array) -> Array:
    values, vectors = np.linalg.eigh(0.5 * (covariance + covariance.T))
    return vectors * np.sqrt(np.maximum(values, 0.0))


@dataclass(frozen=True, eq=False)
class PriorInformation:
    """What is known before the flight: one hypothesis, or two rivals, under one noise.

    `rival_names` names the rivals; `error_dynamics` are those of the filters.
    """

    runs: tuple[ObservedRun, ...]
    rival_names: tuple[str, ...]
    rivals: tuple[FittedHypothesis, ...]
    noise: Noise
    error_dynamics: tuple[AxisErrorDynamics, ...]

    @cached_property
    def seconds(self) -> float:
        """Of the train runs."""
        return float(sum(run.motion.usable.mean() * run.reading_times[-1] for run in self.runs))

    @cached_property
    def readings(self) -> int:
        """Readings that count, of the train runs."""
        return int(sum(run.settled.sum() for run in self.runs))

    @cached_property
    def low_frequency(self) -> tuple[LowFrequencyDisturbance, ...]:
        """What pushes the vehicle for long in the train runs, and each rival does not know of."""
        return tuple(
            estimate_disturbance(rival.hypothesis.model, self.runs, self.noise, self.error_dynamics)
            for rival in self.rivals
        )

    @property
    def deviance_difference(self) -> float:
        """How much less likely the second rival is than the first."""
        return self.rivals[0].two_log_likelihood - self.rivals[1].two_log_likelihood

    @property
    def likely(self) -> Array:
        """Which rivals (r,) the train runs leave possible; without rivals the one hypothesis."""
        found = np.array([rival.two_log_likelihood for rival in self.rivals])
        return found > np.max(found) - 2.0 * np.log(RULED_OUT)
