"""The filters of all runs: they give innovations, and how these change with a model's parameters.

All decisions of a diagnosis are made on these two.
"""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.progress import step
from rovsim.core.threads import map_on_cores
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.autoregression import MIN_COUPLING, Stretches, fit_autoregression
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
from rovsim.estimation.observer.residual_source import (
    Linearised,
    evaluate_possible,
    linearise,
    linearise_centrally,
)

MAX_NOISE_ROUNDS = 3  # at most: by then a wandering current and the disturbance are told apart
RATE_TOLERANCE = 0.05  # of a drift, which its standard deviation exceeds


@dataclass(frozen=True, eq=False)
class FilterBank:
    """Several runs, with filters that suit one model and one noise.

    Attributes:
        runs: what was measured.
        error_dynamics: of `model`, for each of the six axes.
        run_filters: the filters of each run.
        model: that the filters suit.
        coupled: whether axes drive each other (autoregression.py). Innovations can then only
            nearly be converted from one noise to another.
        paths: the current of each run about which everything is linearised; empty for still water.
    """

    runs: tuple[ObservedRun, ...]
    error_dynamics: tuple[AxisErrorDynamics, ...]
    run_filters: tuple[RunFilters, ...]
    model: Model
    coupled: bool = False
    paths: tuple[CurrentPath, ...] = ()

    @staticmethod
    def design(runs: Sequence[ObservedRun], base: Model, noise: Noise) -> "FilterBank":
        """Design the filters of these runs for one model and one noise."""
        errors = estimate_errors(base, runs)
        run_filters = tuple(design_filters(noise.white, errors.by_axis, w) for w in runs)
        coupled, paths = errors.coupling > MIN_COUPLING, noise.drift.paths if noise.drift else ()
        return FilterBank(tuple(runs), errors.by_axis, run_filters, base, coupled, paths)

    def redesign(self, model: Model, noise: Noise) -> "FilterBank":
        """The same runs, with filters that suit another model and noise."""
        return FilterBank.design(self.runs, model, noise)

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Innovations (m, 6, n) of m models on each run; NaN for models that are impossible."""

        def of_run(k: int, run: ObservedRun) -> Array:
            of_possible = partial(self._innovations_of_run, k)
            return evaluate_possible(models, len(run.time), of_possible)

        return map_on_cores(of_run, range(len(self.runs)), self.runs)

    def innovations(self, model: Model) -> list[Array]:
        """Innovations (6, n) of one model on each run."""
        return [e[0] for e in self.evaluate([model])]

    def _innovations_of_run(self, k: int, models: Sequence[Model]) -> Array:
        """Innovations (m, 6, n) of the k-th run."""
        bends = np.array([self._water.bends[k]] * len(models)) if self.paths else None
        return observe(models, self.runs[k], self.run_filters[k], bends)

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Whitened settled innovations (..., 6, n) of all runs, one run after the other.

        Their variance is one if `noise` is right.

        Args:
            e: innovations (..., 6, n_run) of each run, as `evaluate` gives them.
            noise: that should explain them.
        """
        run_filters, past = self.design_filters(noise), noise.autoregression
        z = whiten(e, self.runs, self.run_filters, run_filters)
        if noise.drift:
            z = self._water.walk.whiten(z, noise.drift.rate, run_filters)
        return z if past is None else past.whiten(z, self._stretches)

    @property
    def looks_for_drift(self) -> bool:
        """Whether a wandering current is looked for: only where each axis has one steady filter."""
        steady = all(run.motion.measured is None and run.current_may_drift for run in self.runs)
        return steady and not self.coupled

    def shows_drift(self, noise: Noise) -> bool:
        """Whether a current that wanders as much as usual would be noticed in these runs."""
        return self.looks_for_drift and self._water.shows_drift(self.design_filters(noise))

    @cached_property
    def _water(self) -> MovingWater:
        return MovingWater(self.model, self.runs, self.run_filters, self.paths)

    @cached_property
    def _stretches(self) -> Stretches:
        return Stretches.of(self.runs)

    def flatten(self, rows: Sequence[Array], noise: Noise) -> Array:
        """As `whiten`, for rows (q, 6, n_run) of each run, with the axes joined: (q, 6 n)."""
        return as_rows(self.whiten(rows, noise))

    def design_filters(self, noise: Noise) -> list[RunFilters]:
        """Filters of each run that suit another noise."""
        return [design_filters(noise, self.error_dynamics, w) for w in self.runs]

    def fit_noise(self, e: Sequence[Array], start: Noise, thorough: bool = False) -> NoiseFit:
        """The most likely noise of innovations (6, n_run) of each run.

        Args:
            e: the innovations; several sets of them, one after the other, if they are draws that
                might all be the true ones.
            start: where the fit begins.
            thorough: whether to look for slow errors of the readings and for a wandering current.
        """
        fit = self.fit_axes(e, start, thorough)
        if not self.coupled:
            return self._fit_drift(e, fit) if thorough and self.looks_for_drift else fit
        white = [self.whiten(draw, fit.noise) for draw in self._draws(e)]
        autoregression, lr_statistic = fit_autoregression(white, self._stretches)
        return NoiseFit(
            replace(fit.noise, autoregression=autoregression), fit.two_log_likelihood + lr_statistic
        )

    def fit_axes(self, e: Sequence[Array], start: Noise, thorough: bool = False) -> NoiseFit:
        """As `fit_noise`, but each axis by itself, and with the wandering current of `start`."""
        draws = self._draws(e)
        if start.drift is None:
            return self._fit_without_drift(draws, start, thorough)
        split = [self._subtract_drift(draw, start, start.drift.rate) for draw in draws]
        remainders, walks = [remainder for remainder, _ in split], split[0][1]
        fit = self._fit_without_drift(remainders, start, thorough)
        paths = (CurrentPath(run.time, walk) for run, walk in zip(self.runs, walks, strict=True))
        noise = replace(fit.noise, drift=start.drift._replace(paths=tuple(paths)))
        lr_statistics = [
            self._lr_of_drift(draw, remainder, noise, start.drift.rate)
            for draw, remainder in zip(draws, remainders, strict=True)
        ]
        return NoiseFit(noise, fit.two_log_likelihood + float(np.mean(lr_statistics)))

    def _fit_without_drift(
        self, draws: Sequence[Sequence[Array]], start: Noise, with_bias: bool
    ) -> NoiseFit:
        count = len(draws)
        e = [e_run for draw in draws for e_run in draw]
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
        """Split innovations into sets that each hold every run once."""
        count = len(self.runs)
        return [e[k : k + count] for k in range(0, len(e), count)]

    def _fit_drift(self, e: Sequence[Array], fit: NoiseFit) -> NoiseFit:
        """Add a wandering current to the noise, if the innovations show one for sure."""
        for _ in range(MAX_NOISE_ROUNDS):
            drift, previous = self.measure_drift(self._draws(e)[0], fit.noise), fit.noise.drift
            current = DriftingCurrent(drift.rate.value) if drift.sure else None
            if current is None and previous is None:
                break
            if (
                current
                and previous
                and abs(current.rate - previous.rate) < RATE_TOLERANCE * previous.rate
            ):
                break
            fit = self.fit_axes(e, replace(fit.noise, drift=current), thorough=True)
        return fit

    def measure_drift(self, e: Sequence[Array], noise: Noise) -> DriftFit:
        """The likeliest wandering of the current, from innovations (6, n_run) of each run."""
        return self._water.find_drift(self._whiten_by_run(e, noise), self.design_filters(noise))

    def varies_with_place(self, e: Sequence[Array], noise: Noise) -> bool:
        """Whether a steady flow that varies with place may look like a wandering current."""
        return self._water.varies_with_place(
            self._whiten_by_run(e, noise), self.design_filters(noise)
        )

    def _subtract_drift(
        self, e: Sequence[Array], noise: Noise, rate: float
    ) -> tuple[list[Array], list[Array]]:
        """Subtract a likely wandering current from the innovations of each run.

        Returns:
            The innovations (6, n_run) that are left, and the likeliest current (n_run, 2) in m/s.
        """
        z, run_filters = self._whiten_by_run(e, noise), self.design_filters(noise)
        return self._water.walk.subtract(e, z, rate, run_filters)

    def _lr_of_drift(
        self, e: Sequence[Array], rest: Sequence[Array], noise: Noise, rate: float
    ) -> float:
        """How much likelier innovations are with a drift than what it leaves is without one.

        As a likelihood-ratio statistic; `rest` are the innovations less the drift.
        """
        z, z_rest = self._whiten_by_run(e, noise), self._whiten_by_run(rest, noise)
        removed = sum(float(np.sum(a**2) - np.sum(b**2)) for a, b in zip(z_rest, z, strict=True))
        return removed + self._water.walk.lr_statistic(z, rate, self.design_filters(noise))

    def _whiten_by_run(self, e: Sequence[Array], noise: Noise) -> list[Array]:
        """Settled innovations (6, m) of each run, whitened axis by axis."""
        inputs = zip(e, self.runs, self.run_filters, self.design_filters(noise), strict=True)
        return [whiten_run(*run_inputs) for run_inputs in inputs]

    def linearise(self, at: Hypothesis, previous: Linearised | None = None) -> Linearised:
        """Innovations (6, n) of each run, and their derivatives to the k scaled parameters.

        Args:
            at: the hypothesis.
            previous: another hypothesis, whose derivatives to the same parameters are used again.
        """
        step()
        return linearise(at, self.evaluate, previous)

    def linearise_centrally(self, at: Hypothesis) -> Linearised:
        """As `linearise`, but sure of directions in which nothing changes; twice as long."""
        return linearise_centrally(at, self.evaluate)
