"""Innovations, and how they change with parameters: what all decisions are made of."""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Sequence

from numpy import ndarray as Array

from rovsim.diagnosis.observer.autoregression import COUPLED, Stretches, fit_autoregression
from rovsim.diagnosis.observer.evidence import Linearised, evaluate_possible, linearise
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.innovations import estimate_errors, observe
from rovsim.diagnosis.observer.kalman import AxisMotion
from rovsim.diagnosis.observer.noise import Noise, Tuning, tune, whiten
from rovsim.diagnosis.observer.noise_fit import NoiseFit, fit_noise
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.model import Model


@dataclass(frozen=True, eq=False)
class FilterBank:
    """The runs, and the filters they are observed with.

    `coupled`: axes drive each other (autoregression.py). Innovations found with the filters of one
    noise are then those of another only nearly.
    """

    runs: tuple[ObservedRun, ...]
    motions: tuple[AxisMotion, ...]
    tunings: tuple[Tuning, ...]
    coupled: bool = False

    @staticmethod
    def design(runs: Sequence[ObservedRun], base: Model, noise: Noise) -> "FilterBank":
        """A filter bank that suits this noise."""
        errors = estimate_errors(base, runs)
        found = tuple(tune(noise.white, errors.motions, w) for w in runs)
        return FilterBank(tuple(runs), errors.motions, found, errors.coupling > COUPLED)

    def redesign(self, model: Model, noise: Noise) -> "FilterBank":
        """The same runs, with filters that suit another model and noise."""
        return FilterBank.design(self.runs, model, noise)

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Innovations (m, 6, n) of each run; NaN where a model cannot move at all."""
        return [
            evaluate_possible(models, len(run.time), partial(self._of_run, run, own))
            for run, own in zip(self.runs, self.tunings, strict=True)
        ]

    def innovations(self, model: Model) -> list[Array]:
        """Innovations (6, n) of each run of one model."""
        return [e[0] for e in self.evaluate([model])]

    def _of_run(self, run: ObservedRun, tuning: Tuning, models: Sequence[Model]) -> Array:
        return observe(models, run, tuning)

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Settled innovations (..., 6, n) of all runs, of unit variance if the noise is right."""
        by_axis = whiten(e, self.runs, self.tunings, self.tune(noise))
        past = noise.autoregression
        return by_axis if past is None else past.whiten(by_axis, self._stretches)

    @cached_property
    def _stretches(self) -> Stretches:
        return Stretches.of(self.runs)

    def flatten(self, rows: Sequence[Array], noise: Noise) -> Array:
        """Rows (q, 6, n_run) of each run, whitened, all axes after one another: (q, 6 n)."""
        found = self.whiten(rows, noise)
        return found.reshape(len(found), -1)

    def tune(self, noise: Noise) -> list[Tuning]:
        """Filters of each run that suit another noise."""
        return [tune(noise, self.motions, w) for w in self.runs]

    def fit_noise(self, e: Sequence[Array], start: Noise, colour: bool = False) -> NoiseFit:
        """The most likely noise of innovations (6, n) of each run; see `fit_noise`."""
        found = self.fit_axes(e, start, colour)
        if not self.coupled:
            return found
        draws, runs = self._draws(e), len(self.runs)
        white = [self.whiten(e[k * runs : (k + 1) * runs], found.noise) for k in range(draws)]
        past, gain = fit_autoregression(white, self._stretches)
        return NoiseFit(replace(found.noise, autoregression=past), found.likelihood + gain)

    def fit_axes(self, e: Sequence[Array], start: Noise, colour: bool = False) -> NoiseFit:
        """The same, each axis by itself, also where they are coupled."""
        draws = self._draws(e)
        return fit_noise(
            e, self.runs * draws, self.tunings * draws, self.motions, start, colour, draws
        )

    def _draws(self, e: Sequence[Array]) -> int:
        """How often there are innovations of every run."""
        return len(e) // len(self.runs)

    def linearise(self, at: Hypothesis) -> Linearised:
        """Innovations (6, n), and their derivatives (k, 6, n) to the k scaled parameters."""
        return linearise(at, self.evaluate)
