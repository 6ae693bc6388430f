"""The most likely parameters of a hypothesis, the noise that it leaves, and their spread."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.levenberg_marquardt import levenberg_marquardt
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import as_rows, gram, solve
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.estimation.prior import Prior

# Scales: where much is free at once, what acts only together (drag and a loop, drag and thrust)
# stays near where it began.
REACH = 10.0
POLISHING_ROUNDS = 2  # the noise of the first is already the right one
# Times the reduction that its derivatives predict: so much more a fit may yet reach. Of 234 that
# were given up and went on all the same one gained more (5, of 1), and none what it had to reach.
REACHABLE = 4.0


class GivenUp(Exception):
    """A fit that would not end where it was wanted."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted hypothesis.

    `linearised` with its errors and how they change; `noise` fitted to it; `two_log_likelihood`
    under that noise; `covariance` (k, k) of the scaled parameters.
    """

    linearised: Linearised
    noise: Noise
    two_log_likelihood: float
    covariance: Array

    @property
    def is_finite(self) -> bool:
        """Whether the model stayed finite beside its filters; if not, nothing is known of it."""
        return bool(np.isfinite(self.two_log_likelihood))

    @property
    def hypothesis(self) -> Hypothesis:
        """The hypothesis at its most likely values."""
        return self.linearised.hypothesis

    @property
    def std(self) -> Array:
        """Standard deviations (k,) of the scaled parameters."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    @property
    def z_scores(self) -> Array:
        """How far the free parameters (k,) are from their absence, in standard deviations."""
        return (self.hypothesis.x - self.hypothesis.absence) / np.maximum(self.std, 1e-12)

    def distance(self, own: Sequence[int] | Array) -> float:
        """Of some parameters from their absence, squared, in standard deviations (Wald 1943)."""
        off, V = (self.hypothesis.x - self.hypothesis.absence)[own], self.covariance[own][:, own]
        return float(off @ solve(V, off))


def fit(start: Hypothesis, bank: FilterBank, noise: Noise, reach: float = np.inf) -> Fit:
    """Fit the free parameters under a given noise, then the noise to what is left.

    `reach`, in scales: a prior's standard deviation about the start, which keeps parameters that
    only act together from running away together.

    A model that diverges in spite of the observer's corrections is infinitely unlikely.
    """
    return judge(levenberg_marquardt(start, bank, noise, Prior.around(start.x, reach)), bank, noise)


def fit_or_give_up(
    first: Linearised, bank: FilterBank, noise: Noise, least: float, reach: float = np.inf
) -> Fit | None:
    """The same, but None as soon as nothing says that its `two_log_likelihood` reaches `least`.

    `first`: a start, and derivatives that are roughly right there.
    """

    def monitor(seen: Linearised, predicted_reduction: float) -> None:
        here = bank.fit_noise(seen.e, noise).two_log_likelihood
        if here + REACHABLE * predicted_reduction < least:
            raise GivenUp

    prior = Prior.around(first.hypothesis.x, reach)
    try:
        return judge(
            levenberg_marquardt(first.hypothesis, bank, noise, prior, first, monitor), bank, noise
        )
    except GivenUp:
        return None


def polish(
    start: Fit, runs: Sequence[ObservedRun], reach: float = np.inf
) -> tuple[Fit, FilterBank]:
    """Fitted once more to these runs under its own noise, with filters that suit it.

    As far as filters under that noise hold the model.
    """

    def again(start: Fit) -> tuple[Fit, FilterBank]:
        bank = FilterBank.design(runs, start.hypothesis.model, start.noise)
        return fit(start.hypothesis, bank, start.noise, reach), bank

    polished = again(start)
    for _ in range(1, POLISHING_ROUNDS):
        finer = again(polished[0])
        if not finer[0].is_finite:
            break
        polished = finer
    return polished


def judge(seen: Linearised, bank: FilterBank, noise: Noise, prior: Prior | None = None) -> Fit:
    """A hypothesis as it stands, the noise fitted to what it leaves, beside what was known."""
    if not seen.finite:
        unknown = np.full((len(seen.hypothesis.x), len(seen.hypothesis.x)), np.inf)
        return Fit(seen, noise, -np.inf, unknown)
    own, two_log_likelihood = bank.fit_noise(seen.e, noise)
    information = gram(as_rows(bank.whiten(seen.J, own)))
    if prior is not None:
        information = information + np.diag(prior.weights(seen.hypothesis.x))
    return Fit(seen, own, two_log_likelihood, solve(information, np.eye(len(information))))
