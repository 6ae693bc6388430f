"""A vehicle file that is off in several ways is off in others, too little to be found.

What was selected was fitted as if all the rest of the file were right. Where several of its effects
were selected, the rest is taken for known as such files are known (`nominal_terms.py`), and what
that leaves open is added to the intervals: how far the rest is open beside the runs, and how far
the runs draw it from what the file says. The gain of the thrusters is part of the rest: a mass that
was left as it is would fix the common scale, and is as little known.
"""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.checks.common_scale import (
    GAIN_NAME,
    CommonScale,
    describe_fitted_scale,
    describe_scale,
    include_scale,
)
from rovsim.diagnosis.checks.nuisance_parameters import leave_open
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.least_squares import solve
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.selection.fit import Fit
from rovsim.diagnosis.selection.nominal_terms import (
    ONE_GAIN,
    SEVERAL,
    STATED,
    is_off,
    spread_of_file,
)
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.effects.thrusters import THRUSTERS, ThrusterGain


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
    opened = leave_open(fit, freed, runs) if is_off(h) and further else None
    if opened is None:
        return include_scale(fit, runs)
    spread = list_spreads(h, freed)
    rest = solve(opened.told + np.diag(spread**-2.0), np.eye(len(spread)))
    drawn = rest @ opened.drawn
    wider = opened.along @ (rest + np.outer(drawn, drawn)) @ opened.along.T
    fit = replace(fit, covariance=fit.covariance + wider)
    if GAIN_NAME not in further:
        return fit, describe_fitted_scale(fit)
    gain = further.index(GAIN_NAME)
    variance = float(rest[gain, gain])
    return fit, describe_scale(fit, variance, opened.along @ rest[:, gain] / variance)


def free_rest(h: Hypothesis) -> Hypothesis:
    """With all free that the file states; each thruster's own gain where several differ."""
    fitted = set(h.parameter_names)
    for effect in (built_in()[name] for name in STATED):
        left = tuple(k for k in _list_stated(effect, h) if f"{effect.id}.{k}" not in fitted)
        if left:
            h = h.with_term(Term(effect(), left))
    return h


def _list_stated(effect: type[Effect], h: Hypothesis) -> Sequence[str]:
    if effect is not ThrusterGain:
        return [p.name for p in effect.parameters if p.fitted]
    own = THRUSTERS[: h.base.vehicle.thruster_count]
    selected = sum(f"{ThrusterGain.id}.{name}" in h.parameter_names for name in own)
    return (*ONE_GAIN, *own) if selected >= SEVERAL else ONE_GAIN


def list_spreads(h: Hypothesis, freed: Hypothesis) -> Array:
    """How far the file may be off (n,) in each parameter that only `freed` has, scaled."""
    known = [(type(t.effect), p) for t in freed.terms for p in t.parameters]
    each = zip(freed.parameter_names, known, strict=True)
    new = [one for name, one in each if name not in h.parameter_names]
    return np.array([spread_of_file(h.base, *one) for one in new])
