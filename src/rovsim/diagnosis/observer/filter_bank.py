"""Innovations, and how they change with parameters: what all decisions are made of."""

from dataclasses import dataclass
from functools import partial
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.innovations import damping_rates, observe
from rovsim.diagnosis.observer.least_squares import coarse
from rovsim.diagnosis.observer.noise import Noise, Tuning, fit_noise, tuning, whitened
from rovsim.diagnosis.observer.observed_run import Watch
from rovsim.dynamics.actuation import Between
from rovsim.dynamics.model import Model

STEP = 0.02  # of a parameter's scale: far above rounding, far below curvature


@dataclass(frozen=True, eq=False)
class Observatory:
    """The runs, and the filters they are observed with."""

    watches: tuple[Watch, ...]
    damping: Array
    tunings: tuple[Tuning, ...]
    between: Between

    @staticmethod
    def built(
        watches: Sequence[Watch], base: Model, noise: Noise, between: Between
    ) -> "Observatory":
        """An observatory whose filters suit this noise."""
        damping = damping_rates(base, watches, between)
        found = tuple(tuning(noise, damping, w) for w in watches)
        return Observatory(tuple(watches), damping, found, between)

    def suiting(self, model: Model, noise: Noise) -> "Observatory":
        """The same runs, with filters that suit another model and noise."""
        return Observatory.built(self.watches, model, noise, self.between)

    def innovations(self, models: Sequence[Model]) -> list[Array]:
        """Innovations (m, 6, n) of each run; NaN where a model cannot move at all."""
        return [
            of_possible(models, len(watch.time), partial(self._of_run, watch, own))
            for watch, own in zip(self.watches, self.tunings, strict=True)
        ]

    def _of_run(self, watch: Watch, tuning: Tuning, models: Sequence[Model]) -> Array:
        return observe(models, watch, tuning, self.between)

    def white(self, e: Sequence[Array], noise: Noise) -> Array:
        """Settled innovations (..., 6, n) of all runs, of unit variance if the noise is right."""
        return whitened(e, self.watches, self.tunings, self.tuned(noise))

    def coarse(self, rows: Sequence[Array], noise: Noise) -> Array:
        """Rows (q, 6, n_run) of each run, whitened, a few neighbours together: (q, m)."""
        found = coarse(self.white(rows, noise))
        return found.reshape(len(found), -1)

    def tuned(self, noise: Noise) -> list[Tuning]:
        """Filters of each run that suit another noise."""
        return [tuning(noise, self.damping, w) for w in self.watches]

    def noise(self, e: Sequence[Array], start: Noise) -> tuple[Noise, float]:
        """The most likely noise of innovations (6, n) of each run; twice its log likelihood."""
        return fit_noise(e, self.watches, self.tunings, self.damping, start)

    def linearised(self, at: Hypothesis) -> tuple[list[Array], list[Array]]:
        """Innovations (6, n), and their derivatives (k, 6, n) to the k scaled parameters."""
        return linearised(at, self.innovations)


def of_possible(
    models: Sequence[Model], count: int, errors: Callable[[Sequence[Model]], Array]
) -> Array:
    """Errors (m, 6, count) of models; NaN where a model cannot move at all."""
    able = [m.possible for m in models]
    e = np.full((len(models), 6, count), np.nan)
    if any(able):
        e[able] = errors([m for m, yes in zip(models, able, strict=True) if yes])
    return e


def linearised(
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
