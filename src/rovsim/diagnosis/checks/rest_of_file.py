"""A vehicle file that is off in several ways is off in others, too little to be found.

What was selected was fitted as if all the rest of the file were right. Where several of its effects
were selected, the rest is taken for known as such files are known (`nominal_terms.py`), and what
that leaves open is added to the intervals: how far the rest is open beside the runs, and how far
the runs draw it from what the file says.
"""

from dataclasses import replace
from typing import Sequence

import numpy as np

from rovsim.diagnosis.checks.left_open import leave_open, name_parameters
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.least_squares import solve
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.selection.gauss_newton import Fit
from rovsim.diagnosis.selection.nominal_terms import STATED, spread_of_file
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.effects.thrusters import ThrusterGain

SEVERAL = 3  # effects that a file states: one or two may be all that is wrong
COEFFICIENTS = tuple(name for name in STATED if name != ThrusterGain.id)  # its gain: common_scale


def include_rest(found: Fit, runs: Sequence[ObservedRun]) -> Fit:
    """A fit whose intervals hold what the rest of the vehicle file may be off by.

    Args:
        found: the final fit.
        runs: those it was fitted to.
    """
    if sum(term.id in STATED for term in found.hypothesis.terms) < SEVERAL:
        return found
    freed = _free_rest(found.hypothesis)
    opened = leave_open(found, freed, runs)
    if opened is None or not opened.along.size:
        return found
    spread = _list_spreads(found.hypothesis, freed)
    rest = solve(opened.told + np.diag(spread**-2.0), np.eye(len(spread)))
    drawn = rest @ opened.drawn
    wider = opened.along @ (rest + np.outer(drawn, drawn)) @ opened.along.T
    return replace(found, covariance=found.covariance + wider)


def _free_rest(h: Hypothesis) -> Hypothesis:
    """With all free that the file states."""
    fitted = set(name_parameters(h))
    for name in COEFFICIENTS:
        effect = built_in()[name]
        left = [p.name for p in effect.parameters if p.fitted and f"{name}.{p.name}" not in fitted]
        if left:
            h = h.with_term(Term(effect(), tuple(left)))
    return h


def _list_spreads(h: Hypothesis, freed: Hypothesis) -> np.ndarray:
    """How far the file may be off (n,) in each parameter that only `freed` has, scaled."""
    fitted = set(name_parameters(h))
    return np.array(
        [
            spread_of_file(h.base, type(term.effect), p)
            for term in freed.terms
            for p in term.parameters
            if f"{term.id}.{p.name}" not in fitted
        ]
    )
