"""The noise that is left when a hypothesis and all candidates explain what they can."""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.model import Model
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import gram
from rovsim.estimation.observer.noise import FIRST_NOISE, Noise
from rovsim.estimation.observer.noise_fit import NoiseFit
from rovsim.estimation.sensitivities import Sensitivities

SEED = 0  # of the remainders that are drawn
MIN_READINGS = 10_000  # of fewer, several remainders are drawn, or their noise would be chance
MAX_NOISE_ROUNDS = 10  # at most, where the noise is not yet known
LOG_STD_TOLERANCE = 0.1  # of the disturbance: it has converged if it changes by less
MIN_LR_OF_OWN_NOISE = 1.0  # a hypothesis' own noise has converged if the gain is less
RIDGE_SHARE = 1e-4  # of each column's own square: parallel candidates share


def fit_remaining_noise(
    sensitivities: Sensitivities, at: Hypothesis, noise: Noise, rounds: int = MAX_NOISE_ROUNDS
) -> Noise:
    """Fit the noise to what is left when a hypothesis and all candidates act together.

    Whatever is still missing, this noise is close to the true one, so candidates are compared under
    it. What is left depends on the noise in turn, so the fit is repeated.

    Where axes drive each other, a wrong noise on one axis can look like an effect on another, and
    each then supports the other. So the noise of the hypothesis alone is returned where it is
    likelier by more than one for each column, which is what columns explain by chance.

    Args:
        sensitivities: the columns of all candidates.
        at: the hypothesis.
        noise: where the fit begins.
        rounds: how often the fit is made, at most. The last one also looks for slow errors of the
            readings and for a wandering current.
    """
    bank, e, columns = sensitivities.bank, sensitivities.base, sensitivities.columns
    if at.terms:
        linearised = bank.linearise(at)
        e, columns = linearised.e, _join(linearised.J, columns)
    for _ in range(rounds - 1):
        previous = noise
        noise = bank.fit_axes(draw_remainder(bank, e, columns, previous), previous).noise
        if (
            np.max(np.abs(np.log(noise.disturbance_std / previous.disturbance_std)))
            < LOG_STD_TOLERANCE
        ):
            break
    fit = bank.fit_noise(draw_remainder(bank, e, columns, noise), noise, thorough=True)
    own_fit = _fit_own_noise(bank, at.model, fit.noise)
    likelier = own_fit.two_log_likelihood > fit.two_log_likelihood + sensitivities.count
    return (own_fit if likelier else fit).noise


def _fit_own_noise(bank: FilterBank, model: Model, noise: Noise) -> NoiseFit:
    """Fit the noise on the assumption that a model lacks nothing, with filters that suit it.

    Each round starts from the same guess, since a level that has fallen to zero would stay there.
    """
    start = replace(
        FIRST_NOISE,
        bias_std=noise.bias_std,
        bias_correlation_time=noise.bias_correlation_time,
        drift=noise.drift,
    )
    fit = NoiseFit(noise, -np.inf)
    for _ in range(MAX_NOISE_ROUNDS):
        bank = bank.redesign(model, fit.noise)
        refit = bank.fit_noise(bank.innovations(model), start)
        if not refit.two_log_likelihood > fit.two_log_likelihood + MIN_LR_OF_OWN_NOISE:
            break
        fit = refit
    return fit


def _join(J: Sequence[Array], columns: Sequence[Array]) -> list[Array]:
    pairs = zip(J, columns, strict=True)
    return [np.concatenate([rows.astype(added.dtype), added]) for rows, added in pairs]


def draw_remainder(
    bank: FilterBank, e: Sequence[Array], columns: Sequence[Array], noise: Noise
) -> list[Array]:
    """Subtract from innovations (6, n) of each run a likely combination of columns (c, 6, n).

    The combination is drawn from its posterior. The best one would be wrong here: it takes as many
    degrees of freedom from the noise as there are columns, in short records nearly all of a slow
    disturbance. Of short records several remainders are drawn.

    Returns:
        The remainder (6, n) of each run; all runs of the first draw, then those of the next.
    """
    target = bank.flatten([e_run[None] for e_run in e], noise)[0]
    white = bank.flatten(columns, noise)
    H = gram(white).astype(float)
    size = np.sqrt(np.diag(H))
    size[size == 0.0] = 1.0
    eigenvalues, vectors = np.linalg.eigh(H / np.outer(size, size))
    eigenvalues = np.maximum(eigenvalues, 0.0) + RIDGE_SHARE
    draws = -(-MIN_READINGS // len(target))
    # by the symmetric root: unlike eigenvectors it hardly changes with a rounding
    normals = vectors.T @ np.random.default_rng(SEED).normal(size=(draws, len(H))).T
    solution = vectors.T @ (white @ target / size) / eigenvalues
    coefficients = (
        vectors @ (normals / np.sqrt(eigenvalues)[:, None] - solution[:, None])
    ).T / size
    return [
        e_run + np.tensordot(x, c, axes=1)
        for x in coefficients
        for e_run, c in zip(e, columns, strict=True)
    ]
