"""A loose vehicle file: its other values are probably wrong, too, by too little to be found.

The accepted effects were fitted as if the rest of the file were right. If several file effects were
accepted, the rest is only known as well as such files are (`estimation/file_effects.py`). The
intervals are then widened by two things: what the runs and this knowledge leave open of the rest,
and how far the runs move it from what the file says. The gain of the thrusters belongs to the rest.
If it did not, a mass that was not fitted would seem to determine the common scale, although it is
no better known.
"""

from dataclasses import replace
from typing import Sequence

import numpy as np

from rovsim.diagnosis.selection.vehicle_file.whole_file import free_rest, list_spreads
from rovsim.diagnosis.uncertainty.common_scale import (
    GAIN_NAME,
    CommonScale,
    describe_fitted_scale,
    describe_scale,
    include_scale,
)
from rovsim.diagnosis.uncertainty.nuisance_parameters import free_nuisance
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.observed_run import ObservedRun


def include_rest(fit: Fit, runs: Sequence[ObservedRun]) -> tuple[Fit, CommonScale | None]:
    """Widen the intervals of a fit by what is unknown of the rest of the file, and of the scale.

    Where the file is not loose, by what is unknown of the common scale alone.

    Args:
        fit: the final fit.
        runs: that it was fitted to.

    Returns:
        The fit, and the common scale; None where that is known.
    """
    h = fit.hypothesis
    with_file = free_rest(h)
    new_names = [name for name in with_file.parameter_names if name not in h.parameter_names]
    nuisance = free_nuisance(fit, with_file, runs) if has_loose_file(h) and new_names else None
    if nuisance is None:
        return include_scale(fit, runs)
    spread = list_spreads(h, with_file)
    covariance = solve(nuisance.information + np.diag(spread**-2.0), np.eye(len(spread)))
    estimate = covariance @ nuisance.score
    added = nuisance.along @ (covariance + np.outer(estimate, estimate)) @ nuisance.along.T
    fit = replace(fit, covariance=fit.covariance + added)
    if GAIN_NAME not in new_names:
        return fit, describe_fitted_scale(fit)
    gain = new_names.index(GAIN_NAME)
    variance = float(covariance[gain, gain])
    return fit, describe_scale(fit, variance, nuisance.along @ covariance[:, gain] / variance)
