"""Rudders and fins: plates in the flow, turned by a command or fixed."""

from copy import copy
from typing import Annotated, Sequence

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat

from rovsim.core.schema import Section
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Effect
from rovsim.dynamics.engine.types import HALF, JET
from rovsim.dynamics.vehicle.curves import NonNegative
from rovsim.dynamics.vehicle.thrusters import Thruster, Triple

AHEAD = np.array([1.0, 0.0, 0.0])
NO_WAKE = -1.0


class Surface(Section):
    """A control surface: position m and normal, FRD, at the angle zero; area m2.

    Ahead, a positive angle (column NAME, rad) lifts along `normal`. `lift_slope` per rad and
    `drag`, of area and the square of the local speed; beyond `stall` rad lift falls.
    `in_wake_of` a thruster: its jet adds to the flow.
    """

    name: str = Field(pattern=r"^[A-Za-z]\w*$")
    position: Triple
    normal: Triple
    area: PositiveFloat
    lift_slope: PositiveFloat
    drag: NonNegative = 0.0
    stall: Annotated[float, Field(gt=0, le=0.7)] = 0.35
    in_wake_of: str | None = None


class Surfaces(Coefficients):
    """Control surfaces: lift and drag at the local velocity through the water."""

    id = "surfaces"
    listed = False
    equation = (
        r"L = \tfrac{\rho}{2} A V^2 C_L(\alpha),\quad C_L = c_\alpha \alpha"
        r"\text{ up to the stall, then } \propto \sin 2\alpha"
    )
    neglects = "interaction with the hull, unsteady flow, span, and how fast it turns"
    source = (
        "Fossen 2021, sec. 9.5 (rudder forces); Viterna & Janetzke 1982, NASA TM-82944 (beyond "
        "the stall); momentum theory of the actuator disc (the wake)"
    )
    parameters = ()

    def __init__(
        self,
        surfaces: Sequence[Surface] = (),
        units: Sequence[Thruster] = (),
        density: float = 1000.0,
    ) -> None:
        super().__init__()
        self.names = tuple(one.name for one in surfaces)
        rows = [_row(one, units, density) for one in surfaces]
        self.rows = np.array(rows, dtype=float).reshape(-1, JET + 1)

    def neutral(self) -> Effect:
        """The same surfaces, which neither lift nor drag."""
        found = copy(self)
        found.rows = self.rows.copy()
        found.rows[:, HALF] = 0.0
        return found

    def enter(self, body: Body) -> None:
        """Add the surfaces, lifting as they should."""
        body.surfaces, body.lifting = self.rows, np.ones(len(self.rows))
        body.places = np.concatenate([body.places, self.rows[:, :3]])


def _row(one: Surface, units: Sequence[Thruster], density: float) -> list[float]:
    """Constants of a surface as `Body.surfaces` has them."""
    normal = np.array(one.normal) / np.linalg.norm(one.normal)
    chord = AHEAD - (AHEAD @ normal) * normal
    chord = chord / np.linalg.norm(chord)
    wake, suction = _wake(one, units, density, chord)
    half = 0.5 * density * one.area
    numbers = [half, one.lift_slope, one.drag, one.stall, wake, suction]
    return [*one.position, *normal, *chord, *numbers]


def _wake(
    one: Surface, units: Sequence[Thruster], density: float, chord: Array
) -> tuple[float, float]:
    """Which thruster's jet it stands in, and what V^2 gains per newton (actuator disc).

    Far behind the disc V^2 = V_a^2 + 2 T / (rho A_disc). Where nobody says how large the propeller
    is, its disc is as large as the surface (assumed).
    """
    if one.in_wake_of is None:
        return NO_WAKE, 0.0
    place = [unit.name for unit in units].index(one.in_wake_of)
    unit = units[place]
    disc = one.area if unit.diameter is None else np.pi / 4.0 * unit.diameter**2
    ahead = np.sign(chord @ np.array(unit.direction))
    return float(place), float(ahead * 2.0 / (density * disc))
