"""The nominal parameters themselves refitted: how far the model comes without any new physics.

Damping, added mass, net buoyancy, its centre and one gain for all thrusters, all at once. What an
effect of another kind pushes goes into them as far as it will, which is why this is a step to
compare with and not a diagnosis.
"""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.diagnosis.diagnose import FIRST_NOISE, enough, usable
from rovsim.diagnosis.evidence import Observatory
from rovsim.diagnosis.fit import fit
from rovsim.diagnosis.hypothesis import Hypothesis, Term
from rovsim.diagnosis.watch import Watch
from rovsim.effects import effect
from rovsim.effects.base import Effect
from rovsim.model import Model
from rovsim.thrust import Between

SINGLE = {"net_buoyancy": ("force",), "buoyancy_center": ("x", "y", "z")}
GAINS = 0.5, 2.0  # a curve measured on the bench; gain, masses and drag are known to one scale only
ROUNDS = 3  # the filters suit the noise of the round before


def refitted(base: Model, train: Sequence[Watch], between: Between) -> Model:
    """The base with its own parameters at their most likely values on the train runs.

    An axis that no run moved keeps its coefficients; with too little to judge all of them stay.
    """
    watches, still, seconds = usable(train)
    if not enough(still, seconds):
        return base.called("refitted")
    here, noise = _start(base, still), FIRST_NOISE
    for _ in range(ROUNDS):
        found = fit(here, Observatory.built(watches, base, noise, between), noise)
        here, noise = _held(found.hypothesis), found.noise
    return here.model.called("refitted")


def _start(base: Model, still: Sequence[str]) -> Hypothesis:
    """All parameters free and unchanged; water neither drives a vehicle nor lightens it."""
    moved, body = tuple(axis for axis in AXES if axis not in still), base.body
    total = {
        "linear_damping": body.linear,
        "quadratic_damping": body.quadratic,
        "added_mass": np.diag(body.M_A),
    }
    terms = [Term(_bounded(effect(name), -t), moved) for name, t in total.items()]
    terms += [Term(effect(name)(), free) for name, free in SINGLE.items()]
    return Hypothesis(base, (*terms, Term(_bounded(effect("thruster_gain"), *GAINS), ("all",))))


def _bounded(cls: type[Effect], low: Array | float, high: Array | float = np.inf) -> Effect:
    """The absent effect, its parameters kept between bounds of this vehicle."""
    lows, highs = (np.broadcast_to(x, len(cls.parameters)) for x in (low, high))
    known = zip(cls.parameters, lows, highs, strict=True)
    parameters = tuple(replace(p, low=float(a), high=float(b)) for p, a, b in known)
    return type(cls.__name__, (cls,), {"parameters": parameters})()


def _held(found: Hypothesis) -> Hypothesis:
    """With what came to rest at a bound held there."""

    def inside(term: Term) -> tuple[str, ...]:
        known = zip(term.parameters, (term.effect[name] for name in term.free), strict=True)
        return tuple(p.name for p, value in known if p.low < value < p.high)

    return replace(found, terms=tuple(Term(t.effect, inside(t)) for t in found.terms))
