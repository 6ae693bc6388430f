"""File effects: values that the vehicle file states, any of which may be wrong."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.base import Effect, Parameter
from rovsim.dynamics.effects.buoyancy import BuoyancyCenter, NetBuoyancy
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Bounds, Hypothesis, Term
from rovsim.estimation.prior import cauchy

DRAG = (LinearDamping, QuadraticDamping)
PROPORTIONAL_EFFECTS = (*DRAG, AddedMass)  # files are off by a share of what they state
PER_AXIS = (*PROPORTIONAL_EFFECTS, ConstantWrench)
ONE_GAIN = ("all",)  # of all thrusters
FILE_EFFECTS = (*PROPORTIONAL_EFFECTS, NetBuoyancy, BuoyancyCenter, ThrusterGain)
FILE_EFFECT_IDS = frozenset(effect.id for effect in FILE_EFFECTS)
MIN_LOOSE_EFFECTS = 3  # file effects: of fewer, the rest of the file may well be right
# How far a vehicle file is off, relative to what it states. Added mass: two published sets for a
# BlueROV2, both from tests in a tank (von Benzon et al. 2022, J. Mar. Sci. Eng. 10, 1898; Wu 2018,
# Flinders University, of the lighter vehicle with six thrusters), differ by 0.41 in its logarithm,
# RMS over the axes: 0.29 for each of them, the two builds included. Drag: theirs differs by 1.2 at
# 0.3 m/s and 0.6 rad/s (by factors of 5 to 6 in translation): so far off is another laboratory's
# file. That one's own is off by a third is assumed, not measured.
FILE_RELATIVE_STDS = {"added_mass": 0.3, "linear_damping": 0.3, "quadratic_damping": 0.3}
# Thrusters: assumed, too; a battery of 4 cells gives 12.8 to 16.8 V, the curve is of one voltage.
GAIN_RELATIVE_STD = 0.1
GAIN_SCALE = next(p.scale for p in ThrusterGain.parameters if p.name in ONE_GAIN)
# What a file states as zero, the ballast and its place may be off by one of the parameter's scales.


def has_loose_file(h: Hypothesis) -> bool:
    """Whether so many file effects were accepted that the whole file is probably a little off."""
    return sum(term.id in FILE_EFFECT_IDS for term in h.terms) >= MIN_LOOSE_EFFECTS


def mark_gain(h: Hypothesis) -> Array:
    """Mask (k,) of the free parameter that is the common gain of all thrusters."""
    names = ((term.id, name) for term in h.terms for name in term.free)
    return np.array([n == (ThrusterGain.id, *ONE_GAIN) for n in names], bool)


def penalize_gain(h: Hypothesis) -> float:
    """Penalty of a common gain of the thrusters that is far from the file's, in 2 log L.

    There is none where the file is not loose: the gain may be all that is wrong. Where it is loose,
    a common factor of all forces and inertias is nearly free, and a gain of 1.6 may be fitted where
    the centre of buoyancy is 4 mm lower. The prior has the tails of a Cauchy distribution, since
    thrusters may also be faulty.
    """
    if not has_loose_file(h):
        return 0.0
    offset = (h.x - h.absence)[mark_gain(h)] * GAIN_SCALE / GAIN_RELATIVE_STD
    return float(np.sum(cauchy(offset**2)))


def spread_of_file(base: Model, effect: type[Effect], parameter: Parameter) -> float:
    """How far the vehicle file may be off in one of its values, in scales of the parameter."""
    if effect.id == ThrusterGain.id:
        return GAIN_RELATIVE_STD / parameter.scale
    return max(1.0, share_of_file(base, effect, parameter))


def share_of_file(base: Model, effect: type[Effect], parameter: Parameter) -> float:
    """How far files are off in a value, as far as that is proportional to the value itself.

    In scales of the parameter; 0 where the file states zero, or nothing is known.
    """
    bounds = _physical_bounds(base).get(effect.id, {}).get(parameter.name)
    file_value = 0.0 if bounds is None else -bounds.low
    return FILE_RELATIVE_STDS.get(effect.id, 0.0) * file_value / parameter.scale


def free_terms(
    base: Model, moved: Sequence[str], effects: Sequence[type[Effect]]
) -> tuple[Term, ...]:
    """Effects with free parameters, at values that change nothing.

    Their bounds keep drag and added mass from becoming negative.

    Args:
        base: the model that they are added to.
        moved: axes that moved; parameters of other axes are not free.
        effects: their classes.
    """
    bounds = _physical_bounds(base)
    return tuple(Term(e(), _choose_free(e, moved), bounds.get(e.id, {})) for e in effects)


def _physical_bounds(base: Model) -> dict[str, dict[str, Bounds]]:
    """Bounds of each change of drag or added mass, by effect and axis: none becomes negative."""
    return {
        name: {a: Bounds(float(-x), np.inf) for a, x in zip(AXES, values, strict=True)}
        for name, values in base.body.stated.items()
    }


def _choose_free(effect: type[Effect], moved: Sequence[str]) -> tuple[str, ...]:
    if effect is ThrusterGain:
        return ONE_GAIN
    if effect in PER_AXIS:
        return tuple(moved)
    return tuple(p.name for p in effect.parameters if p.fitted)
