"""What the vehicle file states, as terms of a hypothesis that may all be wrong."""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.hypothesis import Term
from rovsim.dynamics.effects import effect
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model

DRAG = ("linear_damping", "quadratic_damping")
PER_AXIS = (*DRAG, "added_mass", "constant_wrench")
ONE_GAIN = ("all",)  # of all thrusters


def free_terms(base: Model, moved: Sequence[str], names: Sequence[str]) -> tuple[Term, ...]:
    """Effects, still absent, whose parameters are free; water neither drives nor lightens a body.

    Args:
        base: the model they are added to.
        moved: axes about which something can be said.
        names: the effects.
    """
    return tuple(Term(bounded(base, name), _free(name, moved)) for name in names)


def bounded(base: Model, name: str) -> Effect:
    """The absent effect; a change of drag or added mass leaves none below zero."""
    body, cls = base.body, effect(name)
    total = {
        "linear_damping": body.linear,
        "quadratic_damping": body.quadratic,
        "added_mass": np.diag(body.M_A),
    }
    return kept_between(cls, -total[name], np.inf) if name in total else cls()


def kept_between(cls: type[Effect], low: Array | float, high: Array | float) -> Effect:
    """The absent effect, its parameters kept between bounds of this vehicle."""
    lows, highs = (np.broadcast_to(x, len(cls.parameters)) for x in (low, high))
    known = zip(cls.parameters, lows, highs, strict=True)
    parameters = tuple(replace(p, low=float(a), high=float(b)) for p, a, b in known)
    return type(cls.__name__, (cls,), {"parameters": parameters})()


def _free(name: str, moved: Sequence[str]) -> tuple[str, ...]:
    if name == "thruster_gain":
        return ONE_GAIN
    if name in PER_AXIS:
        return tuple(moved)
    return tuple(p.name for p in effect(name).parameters if p.fitted)
