"""A vehicle file that is off in several ways is off in others, too little to be found.

What was selected was fitted as if all the rest of the file were right. Where several of its effects
were selected, the rest is taken for known as such files are (`estimation/file_effects.py`),
and what that leaves open is added to the intervals: how far the rest is open beside the runs, and
how far the runs draw it from what the file says. The gain of the thrusters is part of the rest: a
mass that was left as it is would fix the common scale, and is as little known.
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
from rovsim.diagnosis.uncertainty.nuisance_parameters import leave_open
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.least_squares import solve
from rovsim.estimation.observer.observed_run import ObservedRun


def include_rest(fit: Fit, runs: Sequence[ObservedRun]) -> tuple[Fit, CommonScale | None]:
    """A fit whose intervals hold what the rest of the vehicle file may be off by, and the scale.

    Where less than several of its effects were selected, they hold the common scale alone.

    Args:
        fit: the final fit.
        runs: those it was fitted to.
    """
    h = fit.hypothesis
    freed = free_rest(h)
    further = [name for name in freed.parameter_names if name not in h.parameter_names]
    opened = leave_open(fit, freed, runs) if has_loose_file(h) and further else None
    if opened is None:
        return include_scale(fit, runs)
    spread = list_spreads(h, freed)
    rest = solve(opened.information + np.diag(spread**-2.0), np.eye(len(spread)))
    drawn = rest @ opened.score
    wider = opened.along @ (rest + np.outer(drawn, drawn)) @ opened.along.T
    fit = replace(fit, covariance=fit.covariance + wider)
    if GAIN_NAME not in further:
        return fit, describe_fitted_scale(fit)
    gain = further.index(GAIN_NAME)
    variance = float(rest[gain, gain])
    return fit, describe_scale(fit, variance, opened.along @ rest[:, gain] / variance)
