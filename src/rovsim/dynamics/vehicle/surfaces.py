"""Control surfaces of a vehicle file: rudders and fins, turned by a command or fixed."""

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
    """A control surface.

    Attributes:
        name: its command column, an angle in rad.
        position: (3) from CO, body axes FRD, m.
        normal: (3) unit vector at the angle zero, body axes FRD. When the vehicle moves ahead, a
            positive angle causes lift along it.
        area: m2.
        lift_slope: slope of the lift coefficient, 1/rad.
        drag: drag coefficient of the profile.
        stall: angle of attack beyond which the lift falls, rad.
        in_wake_of: name of the thruster whose jet adds to the flow, if any.
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
    """Lift and drag of control surfaces at the local velocity relative to the water."""

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
        self.names = tuple(surface.name for surface in surfaces)
        rows = [_row(surface, units, density) for surface in surfaces]
        self.rows = np.array(rows, dtype=float).reshape(-1, JET + 1)

    def neutral(self) -> Effect:
        """The same surfaces without lift and drag."""
        surfaces = copy(self)
        surfaces.rows = self.rows.copy()
        surfaces.rows[:, HALF] = 0.0
        return surfaces

    def enter(self, body: Body) -> None:
        """Set the surfaces of the body, with a factor of 1 on their lift, and add their places."""
        body.surfaces, body.lifting = self.rows, np.ones(len(self.rows))
        body.places = np.concatenate([body.places, self.rows[:, :3]])


def _row(one: Surface, units: Sequence[Thruster], density: float) -> list[float]:
    """The row (15) of a surface in `Body.surfaces`; columns as in `engine.types`."""
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
    """Index of the thruster whose jet a surface is in, and increase of V^2 per thrust, m2/s2 per N.

    Actuator disc: far behind it V^2 = V_a^2 + 2 T / (rho A_disc). If the propeller's diameter is
    not given, the area of the disc is assumed to be that of the surface. The increase is negative
    if the jet is directed against the chord.
    """
    if one.in_wake_of is None:
        return NO_WAKE, 0.0
    k = [unit.name for unit in units].index(one.in_wake_of)
    unit = units[k]
    disc = one.area if unit.diameter is None else np.pi / 4.0 * unit.diameter**2
    ahead = np.sign(chord @ np.array(unit.direction))
    return float(k), float(ahead * 2.0 / (density * disc))
