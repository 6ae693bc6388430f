"""Fit a hypothesis: its likeliest parameters, their covariance, and the noise that it leaves."""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.levenberg_marquardt import levenberg_marquardt
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import as_rows, gram, newton_step, solve
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.estimation.prior import Prior

# Scales: where much is free at once, what acts only together (drag and a loop, drag and thrust)
# stays near where it began.
PRIOR_STD = 10.0
POLISHING_ROUNDS = 2  # the noise of the first is already the right one
MIN_STD = 1e-12  # scales: a standard deviation that may be divided by
# Times the reduction that its derivatives predict: so much more a fit may yet reach. Of 234 that
# were given up and went on all the same one gained more (5, of 1), and none what it had to reach.
MAX_REDUCTION_FACTOR = 4.0


class GivenUp(Exception):
    """A fit was stopped, for it would not have reached the likelihood that was asked for."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted hypothesis with k free parameters.

    Attributes:
        linearised: the hypothesis at its fitted values, its innovations and their derivatives.
        noise: fitted to these innovations.
        two_log_likelihood: twice the log likelihood under that noise, up to a constant; -inf where
            the model diverges.
        covariance: (k, k) of the scaled parameters.
    """

    linearised: Linearised
    noise: Noise
    two_log_likelihood: float
    covariance: Array

    @property
    def is_finite(self) -> bool:
        """Whether the filters kept the model from diverging; if not, the fit tells nothing."""
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
        """Distance of the free parameters (k,) from changing nothing, in standard deviations."""
        return (self.hypothesis.x - self.hypothesis.absence) / np.maximum(self.std, MIN_STD)

    @property
    def correlation(self) -> Array:
        """Correlation (k, k) of the free parameters."""
        std = np.maximum(self.std, MIN_STD)
        return np.asarray(self.covariance / np.outer(std, std))

    def wald_statistic(self, own: Sequence[int] | Array) -> float:
        """Wald statistic of some parameters against changing nothing (Wald 1943).

        Their squared distance from their absence, in standard deviations; `own` are their numbers.
        """
        offset, V = (self.hypothesis.x - self.hypothesis.absence)[own], self.covariance[own][:, own]
        return float(offset @ solve(V, offset))


def fit(start: Hypothesis, bank: FilterBank, noise: Noise, prior_std: float = np.inf) -> Fit:
    """Fit the free parameters under a given noise, then the noise to what they leave.

    A model that diverges in spite of the filters' corrections is infinitely unlikely.

    Args:
        start: where the parameters begin.
        bank: the runs, and the filters that observe them.
        noise: under which the parameters are fitted.
        prior_std: standard deviation, in scales of the parameters, of a prior about the start. It
            keeps parameters that only act together from growing without bound together.
    """
    return fit_noise_only(
        levenberg_marquardt(start, bank, noise, Prior.around(start.x, prior_std)), bank, noise
    )


def fit_or_give_up(
    first: Linearised, bank: FilterBank, noise: Noise, least: float, prior_std: float = np.inf
) -> Fit | None:
    """As `fit`, but give up as soon as `two_log_likelihood` is not expected to reach `least`.

    Args:
        first: where the parameters begin, with derivatives that are about right there.
        bank: see `fit`.
        noise: see `fit`.
        least: what is to be reached.
        prior_std: see `fit`.

    Returns:
        The fit; None where it was given up.
    """

    def monitor(linearised: Linearised, predicted_reduction: float) -> None:
        two_log_likelihood = bank.fit_noise(linearised.e, noise).two_log_likelihood
        if two_log_likelihood + MAX_REDUCTION_FACTOR * predicted_reduction < least:
            raise GivenUp

    prior = Prior.around(first.hypothesis.x, prior_std)
    try:
        return fit_noise_only(
            levenberg_marquardt(first.hypothesis, bank, noise, prior, first, monitor), bank, noise
        )
    except GivenUp:
        return None


def polish(
    start: Fit, runs: Sequence[ObservedRun], prior_std: float = np.inf
) -> tuple[Fit, FilterBank]:
    """Fit a hypothesis to these runs once more, under its own noise and with filters that suit it.

    That is done twice, since the noise changes with it, unless the model diverges with the filters
    of the second time.

    Args:
        start: a fit, perhaps to other runs.
        runs: to fit to.
        prior_std: see `fit`.

    Returns:
        The fit, and the filters that it was made with.
    """

    def again(start: Fit) -> tuple[Fit, FilterBank]:
        bank = FilterBank.design(runs, start.hypothesis.model, start.noise)
        return fit(start.hypothesis, bank, start.noise, prior_std), bank

    polished = again(start)
    for _ in range(1, POLISHING_ROUNDS):
        refined = again(polished[0])
        if not refined[0].is_finite:
            break
        polished = refined
    return polished


def refit_to_rows(fit: Fit, rows: Array) -> Fit:
    """The fit to other errors than its own, to first order, within the ranges of its parameters.

    Args:
        fit: whose noise is kept.
        rows: whitened errors and derivatives (1 + k, 6, n), from which something was left out.
    """
    h, G = fit.hypothesis, gram(as_rows(rows))
    moved = replace(fit.linearised, hypothesis=h.at(h.x + newton_step(G)))
    return replace(fit, linearised=moved, covariance=solve(G[1:, 1:], np.eye(len(h.x))))


def fit_noise_only(
    linearised: Linearised, bank: FilterBank, noise: Noise, prior: Prior | None = None
) -> Fit:
    """Fit the noise to what a hypothesis leaves; its parameters stay as they are.

    Args:
        linearised: the hypothesis, its innovations and their derivatives.
        bank: that these innovations come from.
        noise: where the fit of the noise begins.
        prior: what is known of the parameters besides; it makes their covariance smaller.
    """
    if not linearised.is_finite:
        unknown = np.full((len(linearised.hypothesis.x), len(linearised.hypothesis.x)), np.inf)
        return Fit(linearised, noise, -np.inf, unknown)
    fitted_noise, two_log_likelihood = bank.fit_noise(linearised.e, noise)
    covariance = find_covariance(linearised, bank, fitted_noise, prior)
    return Fit(linearised, fitted_noise, two_log_likelihood, covariance)


def find_covariance(
    linearised: Linearised, bank: FilterBank, noise: Noise, prior: Prior | None = None
) -> Array:
    """Covariance (k, k) of the scaled parameters of a hypothesis, under a given noise.

    Args:
        linearised: the hypothesis, its innovations and their derivatives.
        bank: that these innovations come from.
        noise: of the innovations.
        prior: see `fit_noise_only`.
    """
    information = gram(as_rows(bank.whiten(linearised.J, noise)))
    if prior is not None:
        information = information + np.diag(prior.weights(linearised.hypothesis.x))
    return solve(information, np.eye(len(information)))
