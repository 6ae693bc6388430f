"""Thrusters of a vehicle file: places, directions, force curves, and the mixer of demands."""

from functools import cached_property
from typing import Annotated

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.names import Name
from rovsim.core.schema import Section
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients
from rovsim.dynamics.vehicle.curves import ForceCurve

Triple = tuple[float, float, float]
DOWN = np.array([0.0, 0.0, 1.0])


class Thruster(Section):
    """A thruster.

    Attributes:
        name: its command column.
        spin: sign of the reaction moment about `direction` at positive thrust; 0: none.
        position: (3) from CO, body axes FRD, m.
        direction: (3) of positive thrust, a unit vector in body axes FRD; of an azimuth thruster
            at the angle zero.
        force_curve: its own, if it differs from that of the set.
        azimuth: whether the thruster turns about the body's z axis. A second command column,
            NAME_angle, has the angle in rad, positive from ahead to starboard.
        diameter: of the propeller, m; used for a control surface in its wake.
    """

    name: Name
    spin: Annotated[int, Field(ge=-1, le=1)] = 0
    position: Triple
    direction: Triple
    force_curve: ForceCurve | None = None
    azimuth: bool = False
    diameter: PositiveFloat | None = None


class Mixer(Section):
    """The mixer: for each axis, commands of all n thrusters per unit of demand."""

    surge: tuple[float, ...]
    sway: tuple[float, ...]
    heave: tuple[float, ...]
    roll: tuple[float, ...]
    pitch: tuple[float, ...]
    yaw: tuple[float, ...]


class ThrusterSet(Section):
    """All thrusters, their common force curve, and the mixer from demands to commands.

    Attributes:
        command_limit: largest absolute command that the pilot uses.
        force_curve: of thrusters that have none of their own.
        units: the thrusters.
        mixer: without one, the vehicle cannot be driven by demands.
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

    In the equation of motion an azimuth thruster has two components: its force along the direction
    of the angle zero, and a quarter turn to starboard of that. So n thrusters have k components,
    first one of each thruster, then the second ones of azimuth thrusters.

    Attributes:
        layout: the section of the vehicle file.
        count: n.
        turning: (n,) whether each is an azimuth thruster.
        directions: (k, 3) of the components, body axes.
        positions: (k, 3) m.
        spin: (k,) sign of the reaction moment.
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
        directions = np.array([unit.direction for unit in units], dtype=float).reshape(-1, 3)
        across = np.cross(DOWN, directions[self.turning])
        self.directions = np.concatenate([directions, across.reshape(-1, 3)])
        self.positions = self._doubled(
            np.array([unit.position for unit in units], dtype=float).reshape(-1, 3)
        )
        self.spin = self._doubled(np.array([unit.spin for unit in units], dtype=float))

    def _doubled(self, values: Array) -> Array:
        """Values of the components (k, ...), of those of the thrusters (n, ...)."""
        return np.concatenate([values, values[self.turning]])

    def enter(self, body: Body) -> None:
        """Set the allocation B (6, k): columns are directions and their moments (eq. 9.77)."""
        moments = np.cross(self.positions, self.directions)
        body.B = np.hstack([self.directions, moments]).T.copy()
        body.directions, body.spin = self.directions, self.spin
        body.places = self.positions[: self.count]

    def static_force(self, command: Array, voltage: Array | None = None) -> Array:
        """Forces (m, n), N, of commands (m, n) in [-1, 1]; `voltage` (m,) of the battery, V."""
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
        """The force curve of each thruster, n of them."""
        options = [unit.force_curve or self.layout.force_curve for unit in self.layout.units]
        return [curve for curve in options if curve is not None]

    @cached_property
    def common(self) -> ForceCurve | None:
        """The force curve that all thrusters share; None if they differ."""
        all_equal = self.curves and all(curve == self.curves[0] for curve in self.curves)
        return self.curves[0] if all_equal else None

    def resolved(
        self, force: Array, cosine: Array | None = None, sine: Array | None = None
    ) -> Array:
        """Resolve forces (m, n) into components (m, k), with cos, sin (m, a) of azimuth angles."""
        if not self.turning.any():
            return force
        azimuthing = force[:, self.turning]
        along = force.copy()
        along[:, self.turning] = azimuthing if cosine is None else azimuthing * cosine
        return np.hstack([along, 0.0 * azimuthing if sine is None else azimuthing * sine])
