"""Pushes that wander: a random walk on every run, and what it adds to whitened innovations.

A walk W of rate 1 over T s is the sum of independent normal numbers times
sqrt(2 T) / w sin(w t / T), w = pi/2, 3 pi/2, ... (Karhunen-Loeve; Loeve 1978, Probability Theory
II, section 37). Its slow terms hold nearly all of it; what is faster the disturbance takes.
Whitened innovations without it have the covariance I, with it I + r^2 D'D, D their columns.
"""

from dataclasses import dataclass, field
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize_scalar

from rovsim.core.bounded_cache import Recent
from rovsim.estimation.observer.noise import RunFilters, whiten_run
from rovsim.estimation.observer.observed_run import ObservedRun

MAX_FREQUENCY_HZ = 0.5  # what is faster is too little to be told from the disturbance
LEAD_SECONDS = 60.0  # for which it has wandered when a recording begins: a flight made ready
MIN_POWER_SHARE = 1e-9  # of the largest: directions that show nothing
MIN_RATE, MAX_RATE, RATES_TRIED = 1e-5, 10.0, 80  # rates, from none that shows to larger than any
SEED = 0  # of the noise that is drawn
LOG_RATE_STEP = 0.05  # for the second derivative


class WalkRate(NamedTuple):
    """The likeliest rate of a random walk.

    Attributes:
        value: in the unit of the walk, per sqrt(s).
        std: its standard deviation, in the same unit.
        lr_statistic: of the walk, against none.
    """

    value: float
    std: float
    lr_statistic: float


class _Principal(NamedTuple):
    """Of one run: orthonormal directions (k, 6 m) in which a walk shows, and its power (k,) there.

    `mix` (c, k): the terms of the walk that make them up.
    """

    directions: Array
    power: Array
    mix: Array

    def spread(self, std: Array, chance: Array) -> Array:
        """Terms (c,) of that std (k,) where the walk shows, of normal numbers (c,)."""
        axes = self.mix / np.sqrt(self.power)
        # by the symmetric root: unlike eigenvectors it hardly changes with a rounding
        return np.asarray(axes @ (std * (axes.T @ chance)))


def list_terms(run: ObservedRun) -> Array:
    """Terms (k, n) of a walk of rate 1 at the readings of a run, the first where it begins."""
    lead, duration = run.motion.commands.before, float(run.time[-1])
    w = np.pi * (np.arange(max(1, round(2.0 * MAX_FREQUENCY_HZ * duration))) + 0.5)
    terms = np.sqrt(2.0 * duration) / w[:, None] * np.sin(w[:, None] * run.time / duration)
    return np.vstack([np.full(len(run.time), np.sqrt(LEAD_SECONDS + lead)), terms])


@dataclass(frozen=True, eq=False)
class RandomWalk:
    """One walk for each of d directions on each run.

    `columns` (c, 6, n) of each run: innovations by all terms in all directions, not white,
    `made_by` those filters.
    """

    runs: tuple[ObservedRun, ...]
    columns: tuple[Array, ...]
    made_by: tuple[RunFilters, ...]
    _kept: Recent[list[_Principal]] = field(default_factory=Recent)

    def _decompose(self, wanted: Sequence[RunFilters]) -> list[_Principal]:
        key = tuple((f.gain.tobytes(), f.variance) for filters in wanted for f in filters.filters)
        inputs = zip(self.columns, self.runs, self.made_by, wanted, strict=True)
        return self._kept.get(key, lambda: [_decompose(whiten_run(*x)) for x in inputs])

    def whiten(self, z: Array, rate: float, run_filters: Sequence[RunFilters]) -> Array:
        """Innovations (..., 6, m) of all runs, whitened axis by axis, white beside this walk."""
        out, begin = np.array(z), 0
        for principal in self._decompose(run_filters):
            at = slice(begin, begin + principal.directions.shape[1] // 6)
            rows = z[..., at].reshape(-1, principal.directions.shape[1])
            shrinkage = 1.0 - 1.0 / np.sqrt(1.0 + rate**2 * principal.power)
            projection = (rows @ principal.directions.T * shrinkage) @ principal.directions
            out[..., at] -= projection.reshape(out[..., at].shape)
            begin = at.stop
        return out

    def lr_statistic(
        self, z: Sequence[Array], rate: float, run_filters: Sequence[RunFilters]
    ) -> float:
        """Likelihood-ratio statistic: how much likelier it makes innovations (6, m) of each run."""
        return _WalkLikelihood.of(z, self._decompose(run_filters)).lr_statistic(rate)

    def fit_rate(self, z: Sequence[Array], run_filters: Sequence[RunFilters]) -> WalkRate:
        """The likeliest rate for whitened innovations (6, m) of each run."""
        return _WalkLikelihood.of(z, self._decompose(run_filters)).fit()

    def expected_lr(self, rate: float, run_filters: Sequence[RunFilters]) -> float:
        """The likelihood-ratio statistic that a walk of that rate would reach on average."""
        power = np.concatenate([principal.power for principal in self._decompose(run_filters)])
        return _WalkLikelihood(1.0 + rate**2 * power, power).lr_statistic(rate)

    def subtract(
        self, e: Sequence[Array], z: Sequence[Array], rate: float, run_filters: Sequence[RunFilters]
    ) -> tuple[list[Array], list[Array]]:
        """Innovations (6, n) of each run less a likely walk, and the likeliest walk (n, d).

        What is subtracted is drawn from all that the data allow: the likeliest walk takes the slow
        part of the disturbance, too, which then would seem less than it is, and the walk more.

        Args:
            e: the innovations.
            z: the same, whitened (6, m).
            rate: of the walk.
            run_filters: the filters that made them white.
        """
        remainders, walks, random = [], [], np.random.default_rng(SEED)
        inputs = zip(self._decompose(run_filters), z, e, self.columns, self.runs, strict=True)
        for principal, white, e_run, columns, run in inputs:
            precision = principal.power + rate**-2.0
            mean = principal.mix @ (principal.directions @ white.ravel() / precision)
            draw = mean + principal.spread(precision**-0.5, random.normal(size=len(mean)))
            remainders.append(e_run - np.tensordot(draw, columns, axes=1))
            terms = list_terms(run)
            walks.append(terms.T @ mean.reshape(len(terms), -1))
        return remainders, walks


def fit_common(columns: Sequence[Array], z: Sequence[Array]) -> WalkRate:
    """The likeliest size of what is the same in all runs, for whitened innovations (6, m) of each.

    `columns` (c, 6, m) of each run: innovations, white too, by each of its parts for a size of 1.
    The parts are independent normal numbers.
    """
    rows = np.concatenate([block.reshape(len(block), -1) for block in columns], axis=1)
    white = np.concatenate([block.ravel() for block in z])
    return _WalkLikelihood.of([white], [_decompose(rows)]).fit()


def _decompose(columns: Array) -> _Principal:
    """Of whitened columns (c, 6, m)."""
    columns = columns.reshape(len(columns), -1)
    power, vectors = np.linalg.eigh((columns @ columns.T).astype(float))
    significant = power > MIN_POWER_SHARE * max(power[-1], 1e-300)
    power, vectors = power[significant], vectors[:, significant]
    directions = (vectors / np.sqrt(power)).T @ columns
    return _Principal(directions, power, vectors * np.sqrt(power))


@dataclass(frozen=True, eq=False)
class _WalkLikelihood:
    """Squares (k,) of innovations along the directions of a walk, and its power (k,) there."""

    squares: Array
    power: Array

    @staticmethod
    def of(z: Sequence[Array], principal: Sequence[_Principal]) -> "_WalkLikelihood":
        """Of all runs."""
        pairs = zip(z, principal, strict=True)
        squares = np.concatenate([(p.directions @ white.ravel()) ** 2 for white, p in pairs])
        return _WalkLikelihood(squares, np.concatenate([p.power for p in principal]))

    def lr_statistic(self, rate: float) -> float:
        """Twice the logarithm of the likelihood ratio to no walk."""
        variance = rate**2 * self.power
        return float(np.sum(self.squares * variance / (1.0 + variance) - np.log1p(variance)))

    def fit(self) -> WalkRate:
        """The likeliest rate."""
        log_rates = np.linspace(np.log(MIN_RATE), np.log(MAX_RATE), RATES_TRIED)
        start = log_rates[int(np.argmax([self.lr_statistic(np.exp(x)) for x in log_rates]))]
        width = log_rates[1] - log_rates[0]
        minimum = minimize_scalar(
            lambda x: -self.lr_statistic(np.exp(x)),
            method="bounded",
            bounds=(start - width, start + width),
        )
        x, lr_statistic = float(minimum.x), -float(minimum.fun)
        sides = self.lr_statistic(np.exp(x - LOG_RATE_STEP))
        sides += self.lr_statistic(np.exp(x + LOG_RATE_STEP))
        curvature = (2.0 * lr_statistic - sides) / LOG_RATE_STEP**2
        std = np.exp(x) * np.sqrt(2.0 / curvature) if curvature > 0.0 else np.inf
        return WalkRate(float(np.exp(x)), float(std), lr_statistic)
