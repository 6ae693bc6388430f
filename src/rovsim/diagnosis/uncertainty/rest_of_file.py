"""A loose vehicle file: its other values are probably wrong, too, by too little to be found.

The accepted effects were fitted as if the rest of the file were right. If several file effects were
accepted, the rest is only known as well as such files are (`estimation/file_effects.py`). The
intervals are then widened by two things: what the runs and this knowledge leave open of the rest,
and how far the runs move it from what the file says. The gain of the thrusters belongs to the rest.
If it did not, a mass that was not fitted would seem to determine the common scale, although it is
no better known.

A file that is not loose may deviate, too: each coefficient of drag and added mass by the few per
cent that a workshop leaves open. No single one is found then, and all of them pull the values that
are. How far the whole file is off, as a share of how far files usually are, is what the runs find
likeliest (empirical Bayes; Robbins 1956), and the intervals are widened by that.
"""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.vehicle_file.whole_file import free_rest, list_spreads
from rovsim.diagnosis.uncertainty.common_scale import (
    GAIN_NAME,
    CommonScale,
    describe_fitted_scale,
    describe_scale,
    include_scale,
)
from rovsim.diagnosis.uncertainty.nuisance_parameters import NuisanceParameters, free_nuisance
from rovsim.estimation.file_effects import PROPORTIONAL_EFFECTS, share_of_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.observed_run import ObservedRun

# Of the usual errors of a file (a third): the shares that are compared.
SHARES = np.geomspace(0.01, 1.0, 25)
# Likelihood-ratio statistic: one right file in twenty seems to be off by more (Self & Liang 1987,
# J. Am. Stat. Assoc. 82, 605: half of chi-squared, for a share is not below zero).
MIN_LR_OF_DEVIATIONS = 2.7


def include_rest(
    fit: Fit, runs: Sequence[ObservedRun], loose: bool
) -> tuple[Fit, CommonScale | None]:
    """Widen the intervals of a fit by what is unknown of the rest of the file, and of the scale.

    Args:
        fit: the final fit.
        runs: that it was fitted to.
        loose: whether the rest of the file is as far off as files usually are; else it is by as
            much as the runs find likeliest.

    Returns:
        The fit, and the common scale; None where that is known.
    """
    h = fit.hypothesis
    if not loose:
        return include_scale(_include_deviations(fit, runs), runs)
    with_file = free_rest(h)
    new_names = [name for name in with_file.parameter_names if name not in h.parameter_names]
    nuisance = free_nuisance(fit, with_file, runs) if new_names else None
    if nuisance is None:
        return include_scale(fit, runs)
    fit, covariance = _widen(fit, nuisance, list_spreads(h, with_file))
    if GAIN_NAME not in new_names:
        return fit, describe_fitted_scale(fit)
    gain = new_names.index(GAIN_NAME)
    variance = float(covariance[gain, gain])
    return fit, describe_scale(fit, variance, nuisance.along @ covariance[:, gain] / variance)


def _include_deviations(fit: Fit, runs: Sequence[ObservedRun]) -> Fit:
    """Widen the intervals of a fit by how far drag and added mass seem to be off the file's."""
    h = fit.hypothesis
    with_file = free_rest(h, PROPORTIONAL_EFFECTS)
    if not len(h.x) or with_file is h:
        return fit
    nuisance = free_nuisance(fit, with_file, runs)
    if nuisance is None:
        return fit
    usual = list_spreads(h, with_file, share_of_file)
    share = _find_share(nuisance, usual)
    return _widen(fit, nuisance, share * usual)[0] if share else fit


def _find_share(nuisance: NuisanceParameters, usual: Array) -> float:
    """How far the rest of a file is likeliest off, as a share of what is usual (n,); 0 if unsure.

    The deviations have a normal prior of that spread; their likelihood is marginal of them.
    """
    best, best_lr = 0.0, MIN_LR_OF_DEVIATIONS
    for share in SHARES:
        T = share * usual
        spread = np.eye(len(T)) + T[:, None] * nuisance.information * T
        pull = T * nuisance.score
        lr = float(pull @ solve(spread, pull) - np.linalg.slogdet(spread)[1])
        if lr > best_lr:
            best, best_lr = float(share), lr
    return best


def _widen(fit: Fit, nuisance: NuisanceParameters, spread: Array) -> tuple[Fit, Array]:
    """Widen the intervals by further parameters that are known to so much (n,).

    Returns:
        The fit, and the covariance (n, n) of the further parameters.
    """
    scaled = np.eye(len(spread)) + spread[:, None] * nuisance.information * spread
    covariance = spread[:, None] * solve(scaled, np.diag(spread))
    estimate = covariance @ nuisance.score
    added = nuisance.along @ (covariance + np.outer(estimate, estimate)) @ nuisance.along.T
    return replace(fit, covariance=fit.covariance + added), covariance
