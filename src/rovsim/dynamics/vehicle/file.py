"""The schema of a vehicle file, and the nominal effects that follow from it."""

from typing import ClassVar, get_args

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat

from rovsim.core.axes import AXES
from rovsim.core.names import Name
from rovsim.core.schema import Axis, Section
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Effect, Requirement
from rovsim.dynamics.effects.buoyancy import BuoyancyCenter, NetBuoyancy
from rovsim.dynamics.effects.rigid_body import RigidBody
from rovsim.dynamics.effects.waterplane import WaterplaneStiffness
from rovsim.dynamics.vehicle.cross_flow import CrossFlow, Products
from rovsim.dynamics.vehicle.curves import NonNegative
from rovsim.dynamics.vehicle.hydrodynamics import Hydrodynamics
from rovsim.dynamics.vehicle.surfaces import Surface, Surfaces
from rovsim.dynamics.vehicle.thrusters import Thrusters, ThrusterSet, Triple

ALL_AXES: tuple[Axis, ...] = get_args(Axis)


class Fluid(Section):
    """The water: density, kg/m3; and gravity, m/s2."""

    density: PositiveFloat
    gravity: PositiveFloat


class Moments(Section):
    """Moments and products of inertia about the centre of gravity, kg m2.

    Products are Ixy = sum of m x y and so on; in the inertia matrix they have a minus sign (Fossen
    2021, eq. 3.25). The moment about an axis that is held may be left out.
    """

    Ixx: PositiveFloat | None = None
    Iyy: PositiveFloat | None = None
    Izz: PositiveFloat | None = None
    Ixy: float = 0.0
    Ixz: float = 0.0
    Iyz: float = 0.0


class DryVehicle(Section):
    """Mass and buoyancy of the dry vehicle.

    A vehicle that floats, or is held in heave, roll and pitch, may leave out the displaced volume
    and the centre of buoyancy: it is then neutrally buoyant, at its centre of gravity.

    Attributes:
        mass: kg.
        inertia: about the centre of gravity, kg m2.
        center_of_gravity: (3) from CO, body axes FRD, m.
        displaced_volume: m3.
        center_of_buoyancy: (3) from CO, body axes FRD, m.
    """

    mass: PositiveFloat
    inertia: Moments
    center_of_gravity: Triple
    displaced_volume: PositiveFloat | None = None
    center_of_buoyancy: Triple | None = None


class Waterplane(Section):
    """Hydrostatic stiffness of a floating vehicle: heave N/m, roll and pitch N m/rad.

    It is in addition to the moments of weight at CG and buoyancy at CB. So roll is rho g I_T; or
    rho g V GM_T where the file has CG and CB at the same point (Fossen 2021, sec. 4.2).
    """

    heave: NonNegative = 0.0
    roll: float = 0.0
    pitch: float = 0.0


class Vehicle(Section):
    """A vehicle file, as in conf/vehicle/.

    Attributes:
        name: of the vehicle.
        fluid: density and gravity.
        rigid_body: mass, inertia and buoyancy.
        hydrodynamics: added mass and damping.
        thrusters: their places, force curves and mixer.
        degrees_of_freedom: axes that move; the others are held at rest.
        waterplane: stiffness of a floating vehicle; None if it is submerged.
        cross_flow: coefficients of products of velocities, by their names.
        surfaces: rudders and fins.
    """

    described: ClassVar[str] = "docs/vehicles.md"

    name: Name
    fluid: Fluid
    rigid_body: DryVehicle
    hydrodynamics: Hydrodynamics
    thrusters: ThrusterSet = ThrusterSet()
    degrees_of_freedom: tuple[Axis, ...] = Field(default=ALL_AXES, min_length=1)
    waterplane: Waterplane | None = None
    cross_flow: Products = Field(default_factory=dict)
    surfaces: tuple[Surface, ...] = ()

    def effects(self) -> tuple[Effect, ...]:
        """The nominal physics as effects: the model before other effects are added."""
        optional = (
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
            *(make() for present, make in optional if present),
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
        """Dry mass, kg: without the water inside the vehicle."""
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
        return tuple(surface.name for surface in self.surfaces)

    @property
    def floats(self) -> bool:
        """Whether it has a waterplane."""
        return self.waterplane is not None

    @property
    def lacking(self) -> frozenset[Requirement]:
        """What effects may require of a vehicle, and this one does not have."""
        parts: dict[Requirement, object] = {
            "thrusters": self.thrusters.units,
            "surfaces": self.surfaces,
            "waterplane": self.floats,
        }
        return frozenset(name for name, part in parts.items() if not part)

    @property
    def command_columns(self) -> tuple[str, ...]:
        """Names of the columns of a log of thruster commands: thrusters, then surfaces.

        The command of an azimuth thruster is followed by its angle, NAME_angle.
        """
        units = self.thrusters.units
        groups = [[u.name, f"{u.name}_angle"] if u.azimuth else [u.name] for u in units]
        return (*(name for names in groups for name in names), *self.surface_names)

    @property
    def angles(self) -> tuple[bool, ...]:
        """For each of `command_columns`, whether it is an angle in rad."""
        thrusters = {unit.name for unit in self.thrusters.units}
        return tuple(name not in thrusters for name in self.command_columns)

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
    """Axes along or about which the vehicle does not move, whatever the forces."""

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
        """Set which axes of the body move."""
        body.free = self.free
