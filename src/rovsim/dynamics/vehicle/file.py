"""A vehicle file: what stands in it, and the nominal effects it stands for."""

from typing import ClassVar, get_args

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat

from rovsim import AXES
from rovsim.core.names import Name
from rovsim.core.schema import Axis, Section
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Effect
from rovsim.dynamics.effects.buoyancy import BuoyancyCenter, NetBuoyancy
from rovsim.dynamics.effects.rigid_body import RigidBody
from rovsim.dynamics.effects.waterplane import WaterplaneStiffness
from rovsim.dynamics.vehicle.cross_flow import CrossFlow, Products
from rovsim.dynamics.vehicle.curves import NonNegative
from rovsim.dynamics.vehicle.hydrodynamics import Hydrodynamics
from rovsim.dynamics.vehicle.surfaces import Surface, Surfaces
from rovsim.dynamics.vehicle.thrusters import Thrusters, ThrusterSet, Triple

ALL: tuple[Axis, ...] = get_args(Axis)


class Fluid(Section):
    """Density in kg/m3 and gravity in m/s2."""

    density: PositiveFloat
    gravity: PositiveFloat


class Moments(Section):
    """Moments and products of inertia about the centre of gravity, kg m2.

    Ixy = sum of m x y and so on: they stand in the inertia matrix with a minus (Fossen 2021, eq.
    3.25). A moment about an axis that is held may be left out.
    """

    Ixx: PositiveFloat | None = None
    Iyy: PositiveFloat | None = None
    Izz: PositiveFloat | None = None
    Ixy: float = 0.0
    Ixz: float = 0.0
    Iyz: float = 0.0


class DryVehicle(Section):
    """Mass kg, inertia kg m2, centres m FRD from CO, displaced volume m3.

    A vehicle that floats, or is held in heave, roll and pitch, may leave out what it displaces: it
    is then neutrally buoyant, at its centre of gravity.
    """

    mass: PositiveFloat
    inertia: Moments
    center_of_gravity: Triple
    displaced_volume: PositiveFloat | None = None
    center_of_buoyancy: Triple | None = None


class Waterplane(Section):
    """Stiffness of what floats about its rest: N/m, N m/rad, beside the moments of CG and CB.

    Where CG and CB are one point, roll is rho g V GM_T (Fossen 2021, sec. 4.2), else rho g I_T.
    """

    heave: NonNegative = 0.0
    roll: float = 0.0
    pitch: float = 0.0


class Vehicle(Section):
    """A vehicle file, as in conf/vehicle/."""

    described: ClassVar[str] = "docs/vehicles.md"

    name: Name
    fluid: Fluid
    rigid_body: DryVehicle
    hydrodynamics: Hydrodynamics
    thrusters: ThrusterSet = ThrusterSet()
    degrees_of_freedom: tuple[Axis, ...] = Field(default=ALL, min_length=1)
    waterplane: Waterplane | None = None
    cross_flow: Products = Field(default_factory=dict)
    surfaces: tuple[Surface, ...] = ()

    def effects(self) -> tuple[Effect, ...]:
        """The nominal physics as effects: what "the model" is until others are added."""
        further = (
            (self.waterplane is not None, lambda: _floating(self.waterplane)),
            (self.cross_flow, lambda: CrossFlow(self.cross_flow)),
            (self.surfaces, lambda: Surfaces(self.surfaces, self.thrusters.units, self.density)),
            (not self.free.all(), lambda: HeldAxes(self.free)),
        )
        return (
            self._rigid_body(),
            *self.hydrodynamics.effects(),
            *self._buoyancy(),
            Thrusters(self.thrusters),
            *(make() for given, make in further if given),
        )

    @property
    def density(self) -> float:
        """Density of the water, kg/m3."""
        return self.fluid.density

    @property
    def free(self) -> Array:
        """Which axes (6,) move."""
        return np.array([axis in self.degrees_of_freedom for axis in AXES])

    @property
    def dry_mass(self) -> float:
        """Its mass, kg, without water that it holds."""
        return self.rigid_body.mass

    @property
    def thruster_count(self) -> int:
        """Number of thrusters."""
        return len(self.thrusters.units)

    @property
    def thruster_names(self) -> tuple[str, ...]:
        """Names of the thrusters, in the file's order."""
        return tuple(unit.name for unit in self.thrusters.units)

    @property
    def surface_names(self) -> tuple[str, ...]:
        """Names of the control surfaces, in the file's order."""
        return tuple(one.name for one in self.surfaces)

    @property
    def floats(self) -> bool:
        """Whether it has a waterplane."""
        return self.waterplane is not None

    @property
    def command_columns(self) -> tuple[str, ...]:
        """What a log of thruster commands holds, in this order: thrusters, then surfaces.

        The angle of a thruster that turns follows it.
        """
        units = self.thrusters.units
        own = [[u.name, f"{u.name}_angle"] if u.azimuth else [u.name] for u in units]
        return (*(name for names in own for name in names), *self.surface_names)

    @property
    def angles(self) -> tuple[bool, ...]:
        """Which of `command_columns` are angles in rad."""
        known = {unit.name for unit in self.thrusters.units}
        return tuple(name not in known for name in self.command_columns)

    def _rigid_body(self) -> RigidBody:
        dry = self.rigid_body
        inertia = {name: value for name, value in dry.inertia if value is not None}
        return RigidBody(mass=dry.mass, **inertia, **_place(dry.center_of_gravity))

    def _buoyancy(self) -> tuple[Effect, Effect]:
        dry = self.rigid_body
        volume = dry.displaced_volume or dry.mass / self.density
        center = dry.center_of_buoyancy or dry.center_of_gravity
        force = self.density * self.fluid.gravity * volume
        return NetBuoyancy(force=force), BuoyancyCenter(**_place(center))


def _place(at: Triple) -> dict[str, float]:
    return dict(zip("xyz", at, strict=True))


def _floating(waterplane: Waterplane | None) -> WaterplaneStiffness:
    return WaterplaneStiffness(**dict(waterplane or {}))


class HeldAxes(Coefficients):
    """Axes along and about which the vehicle does not move, whatever pushes."""

    id = "held_axes"
    listed = False
    equation = r"\dot\nu_i = \nu_i = 0"
    neglects = "motion along those axes"
    source = "the vehicle file (Fossen 2021, sec. 6.5: models of three degrees of freedom)"
    parameters = ()

    def __init__(self, free: Array | None = None) -> None:
        super().__init__()
        self.free = np.ones(6, bool) if free is None else free

    def enter(self, body: Body) -> None:
        """Hold them."""
        body.free = self.free
