"""A factor common to thrust, inertia and drag, where nothing of known size determines it.

Newton's law holds as well for s M, s D, s g and s τ: a vehicle that is heavier, has more drag and
stronger thrusters, all by the same factor, moves in the same way. Only what is not fitted
determines the factor: the weight beside a known centre of buoyancy, the dry mass, the thrust curve.
Where inertia and drag were accepted and the gain of the thrusters was not, their values are only as
right as the gain that was assumed. So the gain is freed once more, within the accuracy of vehicle
files, and the intervals of all values that would follow it are widened.
"""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.uncertainty.nuisance_parameters import free_nuisance
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.estimation.file_effects import DRAG, GAIN_RELATIVE_STD, GAIN_SCALE, ONE_GAIN
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun

INERTIA_IDS = ("added_mass", "payload")
GAIN_NAME = f"{ThrusterGain.id}.{ONE_GAIN[0]}"
MIN_SCALE_STD = 0.03  # relative standard deviation: a scale that is known better is not reported
# Of a value's variance: if more comes from the scale, the value is listed.
MIN_SCALE_SHARE = 0.5


@dataclass(frozen=True)
class CommonScale:
    """A common factor that the runs do not determine.

    Attributes:
        std: its relative standard deviation.
        parameters: as `effect.parameter`, whose values follow it.
    """

    std: float
    parameters: tuple[str, ...]


def include_scale(fit: Fit, runs: Sequence[ObservedRun]) -> tuple[Fit, CommonScale | None]:
    """Widen the intervals of a fit by what is unknown of the common scale.

    Args:
        fit: the final fit.
        runs: that it was fitted to.

    Returns:
        The fit, and the scale; None where that is known.
    """
    if not _may_share(fit.hypothesis, runs):
        return fit, None
    if GAIN_NAME in fit.hypothesis.parameter_names:
        return fit, describe_fitted_scale(fit)
    variance, direction = _free_gain(fit, runs)
    covariance = fit.covariance + variance * np.outer(direction, direction)
    fit = replace(fit, covariance=covariance)
    return fit, describe_scale(fit, variance, direction)


def describe_fitted_scale(fit: Fit) -> CommonScale | None:
    """The scale of a fit in which the common gain of the thrusters is free; None if it is known."""
    gain = fit.hypothesis.parameter_names.index(GAIN_NAME)
    variance = float(fit.covariance[gain, gain])
    return describe_scale(fit, variance, fit.covariance[gain] / variance)


def _free_gain(fit: Fit, runs: Sequence[ObservedRun]) -> tuple[float, Array]:
    """Free the gain: its variance, and how the k parameters follow it (k,), all scaled."""
    nuisance = free_nuisance(fit, fit.hypothesis.with_term(Term(ThrusterGain(), ONE_GAIN)), runs)
    if nuisance is None:
        return 0.0, np.zeros(len(fit.std))
    information = max(float(nuisance.information[0, 0]), 0.0)
    return 1.0 / (information + (GAIN_SCALE / GAIN_RELATIVE_STD) ** 2), nuisance.along[:, 0]


def describe_scale(fit: Fit, variance: float, along: Array) -> CommonScale | None:
    """The scale of a fit; None where it is known.

    Args:
        fit: with intervals that include the scale.
        variance: of the gain, scaled.
        along: how the k parameters follow the gain (k,), scaled.
    """
    names, std = fit.hypothesis.parameter_names, GAIN_SCALE * np.sqrt(variance)
    share = variance * along**2 / np.maximum(np.diag(fit.covariance), 1e-300)
    affected = [n for n, s in zip(names, share, strict=True) if s > MIN_SCALE_SHARE]
    return CommonScale(float(std), tuple(affected)) if std > MIN_SCALE_STD and affected else None


def _may_share(h: Hypothesis, runs: Sequence[ObservedRun]) -> bool:
    """Whether inertia and drag were fitted, under commands whose force was not measured."""
    ids = {term.id for term in h.terms}
    logged = {run.motion.commands.kind for run in runs}
    return (
        bool(ids & set(INERTIA_IDS)) and bool(ids & {d.id for d in DRAG}) and "wrench" not in logged
    )
