"""The noise of what a hypothesis leaves and no candidate explains."""

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

DRAW = 0  # seed
MIN_READINGS = 10_000  # the noise of fewer hangs on what was drawn; so more is drawn
ROUNDS = 10  # at most, where the noise is not yet known
LOG_STD_TOLERANCE = 0.1  # changed by less, it is known
MIN_LR_OF_OWN_NOISE = 1.0  # likelier by less, so is a hypothesis' own noise
SHRINK = 1e-4  # of each column's own square: parallel candidates share


def fit_remaining_noise(
    sensitivities: Sensitivities, at: Hypothesis, noise: Noise, rounds: int = ROUNDS
) -> Noise:
    """The noise of what a hypothesis leaves and no candidate explains, all acting together.

    It is close to the true one whatever is still missing: candidates are compared under it. What is
    left depends on the noise in turn, so that this takes up to `rounds`; the last looks for slow
    errors of the readings and for a current that wanders.

    Where axes hang together, a wrong noise of one can pass for an effect on another, and the two
    then hold each other. So it is the noise of the hypothesis alone where that is likelier by more
    than one for each column, which is what chance gives them.
    """
    bank, e, columns = sensitivities.bank, sensitivities.base, sensitivities.columns
    if at.terms:
        seen = bank.linearise(at)
        e, columns = seen.e, _join(seen.J, columns)
    for _ in range(rounds - 1):
        known = noise
        noise = bank.fit_axes(draw_remainder(bank, e, columns, known), known).noise
        if (
            np.max(np.abs(np.log(noise.disturbance_std / known.disturbance_std)))
            < LOG_STD_TOLERANCE
        ):
            break
    fit = bank.fit_noise(draw_remainder(bank, e, columns, noise), noise, thorough=True)
    own = _fit_own_noise(bank, at.model, fit.noise)
    likelier = own.two_log_likelihood > fit.two_log_likelihood + sensitivities.count
    return (own if likelier else fit).noise


def _fit_own_noise(bank: FilterBank, model: Model, noise: Noise) -> NoiseFit:
    """The likeliest noise if nothing is missing from a model, with filters that suit it.

    Each round starts from the first guess: a level that once fell to zero does not come back.
    """
    first = replace(
        FIRST_NOISE,
        bias_std=noise.bias_std,
        bias_correlation_time=noise.bias_correlation_time,
        drift=noise.drift,
    )
    fit = NoiseFit(noise, -np.inf)
    for _ in range(ROUNDS):
        bank = bank.redesign(model, fit.noise)
        again = bank.fit_noise(bank.innovations(model), first)
        if not again.two_log_likelihood > fit.two_log_likelihood + MIN_LR_OF_OWN_NOISE:
            break
        fit = again
    return fit


def _join(J: Sequence[Array], columns: Sequence[Array]) -> list[Array]:
    pairs = zip(J, columns, strict=True)
    return [np.concatenate([own.astype(more.dtype), more]) for own, more in pairs]


def draw_remainder(
    bank: FilterBank, e: Sequence[Array], columns: Sequence[Array], noise: Noise
) -> list[Array]:
    """Innovations (6, n) of each run less a likely combination of all columns (c, 6, n).

    Drawn from all that the data allow: the best combination takes as many numbers' worth of noise
    as there are columns, in short records nearly all of a slow disturbance. Short ones are drawn
    several times, all runs after one another.
    """
    target = bank.flatten([one[None] for one in e], noise)[0]
    white = bank.flatten(columns, noise)
    H = gram(white).astype(float)
    size = np.sqrt(np.diag(H))
    size[size == 0.0] = 1.0
    sure, turn = np.linalg.eigh(H / np.outer(size, size))
    sure = np.maximum(sure, 0.0) + SHRINK
    draws = -(-MIN_READINGS // len(target))
    # by the symmetric root: unlike eigenvectors it hardly changes with a rounding
    chance = turn.T @ np.random.default_rng(DRAW).normal(size=(draws, len(H))).T
    best = turn.T @ (white @ target / size) / sure
    likely = (turn @ (chance / np.sqrt(sure)[:, None] - best[:, None])).T / size
    return [
        one + np.tensordot(x, c, axes=1) for x in likely for one, c in zip(e, columns, strict=True)
    ]
