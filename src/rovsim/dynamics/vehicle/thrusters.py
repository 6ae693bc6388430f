"""Thrusters: where they push, along what, how hard for a command, and who mixes them."""

from functools import cached_property
from typing import Annotated

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat

from rovsim import AXES
from rovsim.core.errors import BadInput
from rovsim.core.names import Name
from rovsim.core.schema import Section
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients
from rovsim.dynamics.vehicle.curves import ForceCurve

Triple = tuple[float, float, float]
DOWN = np.array([0.0, 0.0, 1.0])


class Thruster(Section):
    """Position m and direction of positive thrust, FRD; spin = sign of the reaction moment.

    `force_curve`: its own, where it differs from that of the set. `azimuth`: it turns about the
    body's z axis by the angle in a second command column, NAME_angle in rad, positive from ahead
    to starboard; `direction` is that of the angle zero. `diameter` m of the propeller, where a
    surface stands in its wake.
    """

    name: Name
    spin: Annotated[int, Field(ge=-1, le=1)] = 0
    position: Triple
    direction: Triple
    force_curve: ForceCurve | None = None
    azimuth: bool = False
    diameter: PositiveFloat | None = None


class Mixer(Section):
    """Thruster commands per unit of demand, axis by axis."""

    surge: tuple[float, ...]
    sway: tuple[float, ...]
    heave: tuple[float, ...]
    roll: tuple[float, ...]
    pitch: tuple[float, ...]
    yaw: tuple[float, ...]


class ThrusterSet(Section):
    """All thrusters, their common force curve, and the mixer from demands to commands.

    Without a mixer no demand can be taken. `command_limit`: what the pilot stays within.
    """

    command_limit: PositiveFloat = 1.0
    force_curve: ForceCurve | None = None
    units: tuple[Thruster, ...] = ()
    mixer: Mixer | None = None

    def mixing(self) -> Array:
        """Matrix (n, 6) from demands to thruster commands.

        Raises:
            BadInput: there is no mixer.
        """
        if self.mixer is not None:
            return np.array([getattr(self.mixer, axis) for axis in AXES], dtype=float).T
        raise BadInput(
            "the vehicle has no mixer, and is to follow demands",
            where="the vehicle file",
            expected="thrusters.mixer, which says what each thruster does for a demand",
            remedy="Add it, or log what the thrusters were told.",
        )


class Thrusters(Coefficients):
    """Thrusters with a static force curve: where they push, and how hard for a command.

    A thruster that turns is two in the equation of motion: its force along the direction of the
    angle zero, and a quarter turn to starboard of that. `count` n of them make `components` k.
    """

    id = "thrusters"
    listed = False
    equation = r"\tau = B F,\quad F_i = f_i(c_i)"
    neglects = "dynamics, inflow, reaction torque, interaction"
    source = "the vehicle file"
    parameters = ()

    def __init__(self, layout: ThrusterSet) -> None:
        super().__init__()
        self.layout = layout
        units = layout.units
        self.count = len(units)
        self.turning = np.array([unit.azimuth for unit in units], dtype=bool)
        own = np.array([unit.direction for unit in units], dtype=float).reshape(-1, 3)
        across = np.cross(DOWN, own[self.turning])
        self.directions = np.concatenate([own, across.reshape(-1, 3)])
        self.positions = self._doubled(
            np.array([unit.position for unit in units], dtype=float).reshape(-1, 3)
        )
        self.spin = self._doubled(np.array([unit.spin for unit in units], dtype=float))

    def _doubled(self, values: Array) -> Array:
        """Values of the components (k, ...), from those of the thrusters (n, ...)."""
        return np.concatenate([values, values[self.turning]])

    def enter(self, body: Body) -> None:
        """Set the allocation matrix B (6, k): each column is direction and moment (eq. 9.77)."""
        moments = np.cross(self.positions, self.directions)
        body.B = np.hstack([self.directions, moments]).T.copy()
        body.directions, body.spin = self.directions, self.spin
        body.places = self.positions[: self.count]

    def static_force(self, command: Array, voltage: Array | None = None) -> Array:
        """Force in N of commands (..., n) in [-1, 1]; `voltage` (m,) V of the battery if known."""
        if self.common is not None:
            return self.common.force(command, voltage)
        forces = [c.force(command[..., k], voltage) for k, c in enumerate(self.curves)]
        return np.stack(forces, axis=-1) if forces else np.zeros_like(command)

    @cached_property
    def mixing(self) -> Array:
        """Matrix (n, 6) from demands to thruster commands.

        Raises:
            BadInput: there is no mixer.
        """
        return self.layout.mixing()

    @cached_property
    def curves(self) -> list[ForceCurve]:
        """The curve of each thruster (n)."""
        found = [unit.force_curve or self.layout.force_curve for unit in self.layout.units]
        return [curve for curve in found if curve is not None]

    @cached_property
    def common(self) -> ForceCurve | None:
        """The curve that all of them share, if they do."""
        same = self.curves and all(curve == self.curves[0] for curve in self.curves)
        return self.curves[0] if same else None

    def resolved(
        self, force: Array, cosine: Array | None = None, sine: Array | None = None
    ) -> Array:
        """Forces of the components (m, k), of forces (m, n) and their cos and sin (m, a)."""
        if not self.turning.any():
            return force
        aside = force[:, self.turning]
        along = force.copy()
        along[:, self.turning] = aside if cosine is None else aside * cosine
        return np.hstack([along, 0.0 * aside if sine is None else aside * sine])
