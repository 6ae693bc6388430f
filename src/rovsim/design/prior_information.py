"""What the train runs tell before the flight: about one hypothesis, or about two rivals."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy import ndarray as Array

from rovsim.design.low_frequency_disturbance import LowFrequencyDisturbance, estimate_disturbance
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import PRIOR_STD
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import ObservedRun

MAX_ODDS = 1000.0  # odds against a rival to one: beyond, no flight is needed to reject it


@dataclass(frozen=True, eq=False)
class FittedHypothesis:
    """A hypothesis with k free parameters, fitted to the train runs.

    Attributes:
        hypothesis: at its fitted values.
        information: of the train runs about its scaled parameters (k, k).
        of_interest: numbers (j,) of the parameters that are asked about.
        two_log_likelihood: twice its log likelihood, less the penalty of its parameters.
        widest: the same with all parameters free by which it might fit another rival's flight.
        widest_information: of the train runs about the w scaled parameters of `widest` (w, w).
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

    def covariance(self, more: Array | float = 0.0, prior_std: float = PRIOR_STD) -> Array:
        """Covariance (k, k) of the scaled parameters.

        Args:
            more: information (k, k) besides that of the train runs.
            prior_std: standard deviation, in scales, of a parameter about which nothing is known.
        """
        eye = np.eye(len(self.information))
        return solve(self.information + more + eye / prior_std**2, eye)

    def std(self, more: Array | float = 0.0) -> Array:
        """Standard deviations (j,) of the parameters that are asked about, scaled.

        `more` is information (k, k) besides that of the train runs.
        """
        return np.sqrt(np.maximum(np.diag(self.covariance(more))[self.of_interest], 1e-300))

    def draw(self, count: int, random: np.random.Generator) -> list[Model]:
        """Draw `count` possible models from what the train runs tell, the likeliest model first.

        A parameter that the runs do not tell varies by one scale, the size of a change that is
        worth looking for. A model that is impossible is replaced by the likeliest one.
        """
        h, root = self.hypothesis, _square_root(self.covariance(prior_std=1.0))
        models = [h.model]
        while len(models) < count:
            model = h.at(h.x + root @ random.normal(size=len(h.x))).model
            models.append(model if model.possible else h.model)
        return models


def _square_root(covariance: Array) -> Array:
    values, vectors = np.linalg.eigh(0.5 * (covariance + covariance.T))
    return vectors * np.sqrt(np.maximum(values, 0.0))


@dataclass(frozen=True, eq=False)
class PriorInformation:
    """What is known before the flight.

    Attributes:
        runs: the train runs.
        rival_names: ids of the two effects to be told apart; empty where there is one hypothesis.
        rivals: the hypotheses with either effect, or the one hypothesis.
        noise: under which all of them were fitted.
        error_dynamics: how an error of the model grows or decays on each of the six axes.
    """

    runs: tuple[ObservedRun, ...]
    rival_names: tuple[str, ...]
    rivals: tuple[FittedHypothesis, ...]
    noise: Noise
    error_dynamics: tuple[AxisErrorDynamics, ...]

    @cached_property
    def seconds(self) -> float:
        """How long the usable parts of the train runs last, s."""
        return float(sum(run.motion.usable.mean() * run.reading_times[-1] for run in self.runs))

    @cached_property
    def readings(self) -> int:
        """Number of settled readings of the train runs."""
        return int(sum(run.settled.sum() for run in self.runs))

    @cached_property
    def low_frequency(self) -> tuple[LowFrequencyDisturbance, ...]:
        """For each rival, the lasting disturbance in the train runs that its model lacks."""
        return tuple(
            estimate_disturbance(rival.hypothesis.model, self.runs, self.noise, self.error_dynamics)
            for rival in self.rivals
        )

    @property
    def deviance_difference(self) -> float:
        """By how much less likely the second rival is: twice the log odds, penalties included."""
        return self.rivals[0].two_log_likelihood - self.rivals[1].two_log_likelihood

    @property
    def likely(self) -> Array:
        """Which rivals (r,) the train runs have not ruled out; always true for one hypothesis."""
        scores = np.array([rival.two_log_likelihood for rival in self.rivals])
        return scores > np.max(scores) - 2.0 * np.log(MAX_ODDS)
