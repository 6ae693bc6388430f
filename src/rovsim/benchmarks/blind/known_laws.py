"""The laws that the benchmark hides, and what an equation for each has to be made of.

An equation is right if its largest term acts where the law does, and is made of its quantities.
"""

from dataclasses import dataclass

import numpy as np

from rovsim.benchmarks.blind.laws import (
    Canopy,
    CoupledCubic,
    DivingMoment,
    DriftMoment,
    Shear,
    SideWake,
    Stream,
    Swirl,
    TurningDrag,
    TurningSway,
    Whisker,
)
from rovsim.benchmarks.blind.laws_of_thrusters import Backlash, Slew, SpinUp
from rovsim.benchmarks.blind.outside import (
    OUTSIDE_EFFECTS,
    Compression,
    Jet,
    Squat,
    drawn,
)
from rovsim.dynamics.effects.base import Effect


@dataclass(frozen=True)
class KnownLaw:
    """A law, and what an equation for it has to be made of.

    Attributes:
        effect: that is hidden.
        on: axes that it acts on, in the world or the body.
        quantities: that it depends on.
    """

    effect: type[Effect]
    on: tuple[str, ...]
    quantities: frozenset[str]


def _law(effect: type[Effect], on: str, quantities: str) -> KnownLaw:
    return KnownLaw(effect, tuple(on.split()), frozenset(quantities.split()))


LAWS: dict[str, KnownLaw] = {
    one.effect.id: one
    for one in (
        _law(CoupledCubic, "sway", "u v"),
        _law(DriftMoment, "yaw", "v"),
        _law(TurningDrag, "yaw", "v r"),
        _law(TurningSway, "sway", "u r"),
        _law(DivingMoment, "pitch", "u w"),
        _law(Whisker, "yaw", "v"),
        _law(Canopy, "surge sway heave", "u v w"),
        _law(Squat, "heave", "u v"),
        _law(Swirl, "water", "place"),
        _law(Shear, "water", "place"),
        _law(Stream, "water", "place"),
        _law(Jet, "force", "place"),
        _law(Compression, "force", "depth"),
        _law(SideWake, "sway", "v memory"),
        _law(Backlash, "thrusters", "thrust memory"),
        _law(Slew, "thrusters", "thrust memory"),
        _law(SpinUp, "thrusters", "thrust memory"),
    )
}


def find_outside(name: str) -> type[Effect]:
    """Return the class of physics outside the catalogue, which may be one of the laws."""
    return LAWS[name].effect if name in LAWS else OUTSIDE_EFFECTS[name]


def drawn_law(name: str, random: np.random.Generator) -> Effect:
    """Draw a law at strength 1, as `outside.drawn` does."""
    return drawn(LAWS[name].effect, 1.0, random)
