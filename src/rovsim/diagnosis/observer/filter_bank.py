"""Innovations, and how they change with parameters: what all decisions are made of."""

from dataclasses import dataclass
from functools import partial
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.innovations import estimate_damping, observe
from rovsim.diagnosis.observer.least_squares import coarsen
from rovsim.diagnosis.observer.noise import Noise, Tuning, fit_noise, tune, whiten
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.actuation import Between
from rovsim.dynamics.model import Model

STEP = 0.02  # of a parameter's scale: far above rounding, far below curvature


@dataclass(frozen=True, eq=False)
class FilterBank:
    """The runs, and the filters they are observed with."""

    runs: tuple[ObservedRun, ...]
    damping: Array
    tunings: tuple[Tuning, ...]
    between: Between

    @staticmethod
    def design(
        runs: Sequence[ObservedRun], base: Model, noise: Noise, between: Between
    ) -> "FilterBank":
        """A filter bank that suits this noise."""
        damping = estimate_damping(base, runs, between)
        found = tuple(tune(noise, damping, w) for w in runs)
        return FilterBank(tuple(runs), damping, found, between)

    def redesign(self, model: Model, noise: Noise) -> "FilterBank":
        """The same runs, with filters that suit another model and noise."""
        return FilterBank.design(self.runs, model, noise, self.between)

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Innovations (m, 6, n) of each run; NaN where a model cannot move at all."""
        return [
            of_possible(models, len(run.time), partial(self._of_run, run, own))
            for run, own in zip(self.runs, self.tunings, strict=True)
        ]

    def _of_run(self, run: ObservedRun, tuning: Tuning, models: Sequence[Model]) -> Array:
        return observe(models, run, tuning, self.between)

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Settled innovations (..., 6, n) of all runs, of unit variance if the noise is right."""
        return whiten(e, self.runs, self.tunings, self.tune(noise))

    def coarsen(self, rows: Sequence[Array], noise: Noise) -> Array:
        """Rows (q, 6, n_run) of each run, whitened, a few neighbours together: (q, m)."""
        found = coarsen(self.whiten(rows, noise))
        return found.reshape(len(found), -1)

    def tune(self, noise: Noise) -> list[Tuning]:
        """Filters of each run that suit another noise."""
        return [tune(noise, self.damping, w) for w in self.runs]

    def fit_noise(self, e: Sequence[Array], start: Noise) -> tuple[Noise, float]:
        """The most likely noise of innovations (6, n) of each run; twice its log likelihood."""
        return fit_noise(e, self.runs, self.tunings, self.damping, start)

    def linearise(self, at: Hypothesis) -> tuple[list[Array], list[Array]]:
        """Innovations (6, n), and their derivatives (k, 6, n) to the k scaled parameters."""
        return linearise(at, self.evaluate)


def of_possible(
    models: Sequence[Model], count: int, errors: Callable[[Sequence[Model]], Array]
) -> Array:
    """Errors (m, 6, count) of models; NaN where a model cannot move at all."""
    able = [m.possible for m in models]
    e = np.full((len(models), 6, count), np.nan)
    if any(able):
        e[able] = errors([m for m, yes in zip(models, able, strict=True) if yes])
    return e


def linearise(
    at: Hypothesis, errors: Callable[[Sequence[Model]], list[Array]]
) -> tuple[list[Array], list[Array]]:
    """Errors (6, n) of each run, and their derivatives (k, 6, n) to the k scaled parameters.

    `errors` returns (m, 6, n) of each run for m models.
    """
    x = at.x
    steps = [_inward(at, x, i) for i in range(len(x))]
    moved = [at.at(x + step).model for step in steps]
    sizes = np.array([step.sum() for step in steps])[:, None, None]
    found = errors([at.model, *moved])
    return [f[0] for f in found], [(f[1:] - f[0]) / sizes for f in found]


def _inward(at: Hypothesis, x: Array, i: int) -> Array:
    """A step of one parameter that stays inside its range."""
    step = np.zeros(len(x))
    parameter = [p for term in at.terms for p in term.parameters][i]
    step[i] = max(STEP, parameter.grain / parameter.scale)
    return -step if (x[i] + step[i]) * parameter.scale > parameter.high else step
