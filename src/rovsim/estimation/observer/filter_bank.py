"""Innovations, and how they change with parameters: what all decisions are made of."""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.progress import step
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.autoregression import COUPLED, Stretches, fit_autoregression
from rovsim.estimation.observer.drifting_current import DriftFit, MovingWater
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.innovations import estimate_errors, observe
from rovsim.estimation.observer.kalman import AxisErrorDynamics
from rovsim.estimation.observer.least_squares import as_rows
from rovsim.estimation.observer.noise import (
    CurrentPath,
    DriftingCurrent,
    Noise,
    RunFilters,
    design_filters,
    whiten,
    whiten_run,
)
from rovsim.estimation.observer.noise_fit import NoiseFit, fit_noise
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.residual_source import Linearised, evaluate_possible, linearise

ROUNDS = 3  # at most: what wanders and what pushes for a second are told apart by then
RATE_TOLERANCE = 0.05  # of a drift, which its standard deviation exceeds


@dataclass(frozen=True, eq=False)
class FilterBank:
    """The runs, and the filters they are observed with, which suit a model.

    `coupled`: axes drive each other (autoregression.py). Innovations found with the filters of one
    noise are then those of another only nearly. `paths`: of a current that wanders, about which all
    is linearised.
    """

    runs: tuple[ObservedRun, ...]
    error_dynamics: tuple[AxisErrorDynamics, ...]
    run_filters: tuple[RunFilters, ...]
    model: Model
    coupled: bool = False
    paths: tuple[CurrentPath, ...] = ()

    @staticmethod
    def design(runs: Sequence[ObservedRun], base: Model, noise: Noise) -> "FilterBank":
        """A filter bank that suits this noise."""
        errors = estimate_errors(base, runs)
        run_filters = tuple(design_filters(noise.white, errors.by_axis, w) for w in runs)
        coupled, paths = errors.coupling > COUPLED, noise.drift.paths if noise.drift else ()
        return FilterBank(tuple(runs), errors.by_axis, run_filters, base, coupled, paths)

    def redesign(self, model: Model, noise: Noise) -> "FilterBank":
        """The same runs, with filters that suit another model and noise."""
        return FilterBank.design(self.runs, model, noise)

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Innovations (m, 6, n) of each run; NaN where a model cannot move at all."""
        return [
            evaluate_possible(models, len(run.time), partial(self._innovations_of_run, k))
            for k, run in enumerate(self.runs)
        ]

    def innovations(self, model: Model) -> list[Array]:
        """Innovations (6, n) of each run of one model."""
        return [e[0] for e in self.evaluate([model])]

    def _innovations_of_run(self, k: int, models: Sequence[Model]) -> Array:
        """Innovations (m, 6, n) of the k-th run."""
        pushed = np.array([self._water.bends[k]] * len(models)) if self.paths else None
        return observe(models, self.runs[k], self.run_filters[k], pushed)

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Settled innovations (..., 6, n) of all runs, of unit variance if the noise is right."""
        run_filters, past = self.design_filters(noise), noise.autoregression
        z = whiten(e, self.runs, self.run_filters, run_filters)
        if noise.drift:
            z = self._water.walk.whiten(z, noise.drift.rate, run_filters)
        return z if past is None else past.whiten(z, self._stretches)

    @property
    def looks_for_drift(self) -> bool:
        """Whether a current that wanders is looked for: every axis has its own, steady filter."""
        known = all(run.motion.measured is None and run.current_may_drift for run in self.runs)
        return known and not self.coupled

    def shows_drift(self, noise: Noise) -> bool:
        """Whether a usual drift of the current would be told from none."""
        return self.looks_for_drift and self._water.shows_drift(self.design_filters(noise))

    @cached_property
    def _water(self) -> MovingWater:
        return MovingWater(self.model, self.runs, self.run_filters, self.paths)

    @cached_property
    def _stretches(self) -> Stretches:
        return Stretches.of(self.runs)

    def flatten(self, rows: Sequence[Array], noise: Noise) -> Array:
        """Rows (q, 6, n_run) of each run, whitened, all axes after one another: (q, 6 n)."""
        return as_rows(self.whiten(rows, noise))

    def design_filters(self, noise: Noise) -> list[RunFilters]:
        """Filters of each run that suit another noise."""
        return [design_filters(noise, self.error_dynamics, w) for w in self.runs]

    def fit_noise(self, e: Sequence[Array], start: Noise, thorough: bool = False) -> NoiseFit:
        """The most likely noise of innovations (6, n) of each run; see `fit_noise`.

        `thorough`: whether to look for slow errors of the readings and for a current that wanders.
        """
        fit = self.fit_axes(e, start, thorough)
        if not self.coupled:
            return self._fit_drift(e, fit) if thorough and self.looks_for_drift else fit
        white = [self.whiten(own, fit.noise) for own in self._draws(e)]
        past, more = fit_autoregression(white, self._stretches)
        return NoiseFit(replace(fit.noise, autoregression=past), fit.two_log_likelihood + more)

    def fit_axes(self, e: Sequence[Array], start: Noise, thorough: bool = False) -> NoiseFit:
        """The same, each axis by itself, also where they are coupled; beside a drift as it is."""
        draws = self._draws(e)
        if start.drift is None:
            return self._fit_calm(draws, start, thorough)
        each = [self._subtract_drift(own, start, start.drift.rate) for own in draws]
        rests, walks = [rest for rest, _ in each], each[0][1]
        fit = self._fit_calm(rests, start, thorough)
        paths = (CurrentPath(run.time, walk) for run, walk in zip(self.runs, walks, strict=True))
        noise = replace(fit.noise, drift=start.drift._replace(paths=tuple(paths)))
        lr_statistics = [
            self._lr_of_drift(own, rest, noise, start.drift.rate)
            for own, rest in zip(draws, rests, strict=True)
        ]
        return NoiseFit(noise, fit.two_log_likelihood + float(np.mean(lr_statistics)))

    def _fit_calm(
        self, draws: Sequence[Sequence[Array]], start: Noise, with_bias: bool
    ) -> NoiseFit:
        count = len(draws)
        e = [one for own in draws for one in own]
        return fit_noise(
            e,
            self.runs * count,
            self.run_filters * count,
            self.error_dynamics,
            start,
            with_bias,
            count,
        )

    def _draws(self, e: Sequence[Array]) -> list[Sequence[Array]]:
        """Innovations of every run, as often as there are any."""
        count = len(self.runs)
        return [e[first : first + count] for first in range(0, len(e), count)]

    def _fit_drift(self, e: Sequence[Array], fit: NoiseFit) -> NoiseFit:
        """The noise with a current that wanders, if it does."""
        for _ in range(ROUNDS):
            drift, known = self.measure_drift(self._draws(e)[0], fit.noise), fit.noise.drift
            now = DriftingCurrent(drift.rate.value) if drift.sure else None
            if now is None and known is None:
                break
            if now and known and abs(now.rate - known.rate) < RATE_TOLERANCE * known.rate:
                break
            fit = self.fit_axes(e, replace(fit.noise, drift=now), thorough=True)
        return fit

    def measure_drift(self, e: Sequence[Array], noise: Noise) -> DriftFit:
        """How the current most likely wanders, from innovations (6, n) of each run."""
        return self._water.find_drift(self._whiten_by_run(e, noise), self.design_filters(noise))

    def varies_with_place(self, e: Sequence[Array], noise: Noise) -> bool:
        """Whether a steady flow through the tank may be what seems to wander."""
        return self._water.varies_with_place(
            self._whiten_by_run(e, noise), self.design_filters(noise)
        )

    def _subtract_drift(
        self, e: Sequence[Array], noise: Noise, rate: float
    ) -> tuple[list[Array], list[Array]]:
        """Innovations of each run less a likely drift, and the likeliest current (n, 2)."""
        z, run_filters = self._whiten_by_run(e, noise), self.design_filters(noise)
        return self._water.walk.subtract(e, z, rate, run_filters)

    def _lr_of_drift(
        self, e: Sequence[Array], rest: Sequence[Array], noise: Noise, rate: float
    ) -> float:
        """By how much likelier innovations are with a drift than what it left is without."""
        z, left = self._whiten_by_run(e, noise), self._whiten_by_run(rest, noise)
        more = sum(float(np.sum(a**2) - np.sum(b**2)) for a, b in zip(left, z, strict=True))
        return more + self._water.walk.lr_statistic(z, rate, self.design_filters(noise))

    def _whiten_by_run(self, e: Sequence[Array], noise: Noise) -> list[Array]:
        """Settled innovations (6, m) of each run, whitened axis by axis."""
        each = zip(e, self.runs, self.run_filters, self.design_filters(noise), strict=True)
        return [whiten_run(*one) for one in each]

    def linearise(self, at: Hypothesis, known: Linearised | None = None) -> Linearised:
        """Innovations (6, n), and their derivatives (k, 6, n) to the k scaled parameters.

        `known`: derivatives of another hypothesis, which stand for those to the same parameters.
        """
        step()
        return linearise(at, self.evaluate, known)
