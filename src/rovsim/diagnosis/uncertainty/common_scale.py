"""One factor that thrust, inertia and drag share, where nothing of known size fixes it.

Newton's law holds as well for s M, s D, s g and s τ: a vehicle that is heavier, has more drag and
stronger thrusters, all by the same factor, moves alike. Only what is not free fixes the factor: the
weight beside a known centre of buoyancy, the dry mass, the thrust curve. Where inertia and drag
were selected and the gain of the thrusters was not, their values are right up to the gain that was
assumed. So the gain is freed once more, within what a vehicle file's is known to, and what it
leaves open widens the intervals of all that would go with it.
"""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.uncertainty.nuisance_parameters import leave_open
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.estimation.file_effects import DRAG, GAIN, GAIN_SCALE, ONE_GAIN
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun

INERTIA = ("added_mass", "payload")
GAIN_NAME = f"{ThrusterGain.id}.{ONE_GAIN[0]}"
UNKNOWN = 0.03  # relative standard deviation: a scale that is known better misleads nobody
GOES_ALONG = 0.5  # of a value's variance comes from the scale


@dataclass(frozen=True)
class CommonScale:
    """A factor that the runs leave open: its relative `std`, and what goes along with it.

    `parameters` are `effect.parameter`.
    """

    std: float
    parameters: tuple[str, ...]


def include_scale(fit: Fit, runs: Sequence[ObservedRun]) -> tuple[Fit, CommonScale | None]:
    """A fit whose intervals hold the common scale as well, and the scale where it is unknown.

    Args:
        fit: the final fit.
        runs: those it was fitted to.
    """
    if not _may_share(fit.hypothesis, runs):
        return fit, None
    if GAIN_NAME in fit.hypothesis.parameter_names:
        return fit, describe_fitted_scale(fit)
    variance, along = _free_gain(fit, runs)
    both = fit.covariance + variance * np.outer(along, along)
    fit = replace(fit, covariance=both)
    return fit, describe_scale(fit, variance, along)


def describe_fitted_scale(fit: Fit) -> CommonScale | None:
    """The scale of a fit in which the gain of all thrusters is free; None where it is known."""
    gain = fit.hypothesis.parameter_names.index(GAIN_NAME)
    variance = float(fit.covariance[gain, gain])
    return describe_scale(fit, variance, fit.covariance[gain] / variance)


def _free_gain(fit: Fit, runs: Sequence[ObservedRun]) -> tuple[float, Array]:
    """Variance of the gain once it is free, and how the parameters (k,) follow it, all scaled."""
    opened = leave_open(fit, fit.hypothesis.with_term(Term(ThrusterGain(), ONE_GAIN)), runs)
    if opened is None:
        return 0.0, np.zeros(len(fit.std))
    told = max(float(opened.information[0, 0]), 0.0)
    return 1.0 / (told + (GAIN_SCALE / GAIN) ** 2), opened.along[:, 0]


def describe_scale(fit: Fit, variance: float, along: Array) -> CommonScale | None:
    """The scale where it is unknown: `variance` of the gain, and how parameters (k,) follow it."""
    names, std = fit.hypothesis.parameter_names, GAIN_SCALE * np.sqrt(variance)
    share = variance * along**2 / np.maximum(np.diag(fit.covariance), 1e-300)
    moved = [n for n, s in zip(names, share, strict=True) if s > GOES_ALONG]
    return CommonScale(float(std), tuple(moved)) if std > UNKNOWN and moved else None


def _may_share(h: Hypothesis, runs: Sequence[ObservedRun]) -> bool:
    """Whether inertia and drag were fitted to commands whose force nobody measured."""
    named = {term.id for term in h.terms}
    logged = {run.motion.commands.kind for run in runs}
    return (
        bool(named & set(INERTIA))
        and bool(named & {one.id for one in DRAG})
        and "wrench" not in logged
    )
