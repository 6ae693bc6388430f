"""Gauss-Newton on the innovations: the most likely parameters of a hypothesis, and their spread."""

from dataclasses import dataclass
from typing import Protocol, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.least_squares import inner_products, solve
from rovsim.diagnosis.observer.noise import Noise
from rovsim.dynamics.model import Model

MOST_ITERATIONS = 12
CONVERGED = 0.02  # standard deviations: a smaller step changes nothing anyone could see
ROUGH = 1e-2  # of what the model does not explain: a wrong model need not be fitted finely
# Scales: where much is free at once, what acts only together (drag and a loop, drag and thrust)
# stays near where it began.
REACH = 10.0
FIRST_TRUST, LARGEST_TRUST = 1e-4, 1e4  # damping of the steps (Levenberg-Marquardt)


class Evidence(Protocol):
    """Errors of models, how they change with parameters, and what makes them comparable."""

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Errors (m, 6, n) of each run."""

    def linearise(self, at: Hypothesis) -> tuple[list[Array], list[Array]]:
        """Errors (6, n) of each run and their derivatives (k, 6, n)."""

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Errors (..., 6, n) of all runs, each worth the same."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted hypothesis.

    `e` (6, n) and `J` (k, 6, n) of each run, not whitened; `noise` fitted to it; `likelihood` twice
    the log likelihood under that noise; `covariance` (k, k) of the scaled parameters.
    """

    hypothesis: Hypothesis
    e: list[Array]
    J: list[Array]
    noise: Noise
    likelihood: float
    covariance: Array

    @property
    def std(self) -> Array:
        """Standard deviations (k,) of the scaled parameters."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))


def fit(start: Hypothesis, bank: FilterBank, noise: Noise, reach: float = np.inf) -> Fit:
    """Fit the free parameters under a given noise, then the noise to what is left.

    `reach`: see `descend`.

    A model that diverges in spite of the observer's corrections is infinitely unlikely.
    """
    return judge(*descend(start, bank, noise, reach), bank, noise)


def judge(here: Hypothesis, e: list[Array], J: list[Array], bank: FilterBank, noise: Noise) -> Fit:
    """A hypothesis as it stands, the noise fitted to what it leaves."""
    if not _finite(e, J):
        unsure = np.full((len(here.x), len(here.x)), np.inf)
        return Fit(here, e, J, noise, -np.inf, unsure)
    own, likelihood = bank.fit_noise(e, noise)
    rows = _rows(bank.whiten(J, own))
    return Fit(here, e, J, own, likelihood, solve(inner_products(rows), np.eye(len(rows))))


def _finite(e: list[Array], J: list[Array]) -> bool:
    """Whether the observer could hold the model on all runs, there and a step beside."""
    return all(np.isfinite(one).all() for one in (*e, *J))


def _rows(white: Array) -> Array:
    return white.reshape(len(white), int(np.prod(white.shape[1:])))


def _cost(bank: Evidence, e: list[Array], noise: Noise) -> float:
    white = bank.whiten(e, noise)
    return float(np.sum(white**2))


def descend(
    here: Hypothesis, bank: Evidence, noise: Noise, reach: float = np.inf
) -> tuple[Hypothesis, list[Array], list[Array]]:
    """Least squares from a hypothesis: where it leads, its errors and their derivatives.

    `reach`, in scales: a prior's standard deviation about the start, which keeps parameters that
    only act together from running away together.
    """
    trust, start = FIRST_TRUST, here.x

    def prior(x: Array) -> float:
        return float(np.sum(((x - start) / reach) ** 2))

    for _ in range(MOST_ITERATIONS):
        e, J = bank.linearise(here)
        if not len(here.x) or not _finite(e, J):
            return here, e, J
        rows = _rows(bank.whiten(J, noise))
        target = bank.whiten(e, noise).ravel()
        H, g, cost = inner_products(rows), rows @ target, float(target @ target)
        H, g = H + np.eye(len(H)) / reach**2, g + (here.x - start) / reach**2
        cost += prior(here.x)

        def left(wanted: Hypothesis) -> float:
            e = [one[0] for one in bank.evaluate([wanted.model])]
            return _cost(bank, e, noise) + prior(wanted.x) if _finite(e, []) else np.inf

        step, better, cost, trust = _step(here, left, H, g, cost, trust)
        if better is None:
            return here, e, J
        here = better
        excess = max(0.0, cost - len(target))
        if float(step @ H @ step) < max(CONVERGED**2 * len(step), ROUGH * excess):
            break
    e, J = bank.linearise(here)
    return here, e, J


def _step(here, cost_of, H, g, cost, trust):
    """A step that lowers the cost, where it leads and what is left; None when none does."""
    x = here.x
    while trust < LARGEST_TRUST:
        goal = x - solve(H + trust * np.diag(np.diag(H)), g)
        if not np.isfinite(goal).all():
            break
        wanted = here.at(goal)
        step = wanted.x - x
        left = cost_of(wanted)
        if left < cost:
            return step, wanted, left, max(trust / 10.0, 1e-8)
        if float(step @ H @ step) < CONVERGED**2:
            return step, None, cost, trust
        trust *= 10.0
    return np.zeros_like(x), None, cost, trust
