"""A vehicle file, and the nominal effects it stands for."""

from pathlib import Path
from typing import Annotated

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveFloat

from rovsim import AXES
from rovsim.core.errors import BadInput, nearest
from rovsim.core.files import read_yaml
from rovsim.core.schema import Section, checked
from rovsim.core.shipped import conf_file, conf_names
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.base import Coefficients, Effect
from rovsim.dynamics.effects.buoyancy import BuoyancyCenter, NetBuoyancy
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.dynamics.effects.rigid_body import RigidBody

Triple = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]
NonNegative = Annotated[float, Field(ge=0)]
SixNonNegative = tuple[NonNegative, NonNegative, NonNegative, NonNegative, NonNegative, NonNegative]


class Fluid(Section):
    """Density in kg/m3 and gravity in m/s2."""

    density: PositiveFloat
    gravity: PositiveFloat


class Moments(Section):
    """Moments of inertia about the centre of gravity, kg m2."""

    Ixx: PositiveFloat
    Iyy: PositiveFloat
    Izz: PositiveFloat


class DryVehicle(Section):
    """Mass kg, inertia kg m2, centres m FRD from CO, displaced volume m3."""

    mass: PositiveFloat
    inertia: Moments
    center_of_gravity: Triple
    displaced_volume: PositiveFloat
    center_of_buoyancy: Triple


class Hydrodynamics(Section):
    """Added mass and damping per axis; positive = inertia, drag."""

    added_mass: SixNonNegative
    linear_damping: SixNonNegative
    quadratic_damping: SixNonNegative


class ForceCurve(Section):
    """N = sum_k a_k c^(2k+1) for a command c in [-1, 1]: odd, so equal both ways."""

    odd_polynomial: tuple[float, ...] = Field(min_length=1)


class Thruster(Section):
    """Position m and direction of positive thrust, FRD; spin = sign of the reaction moment."""

    name: str
    spin: Annotated[int, Field(ge=-1, le=1)]
    position: Triple
    direction: Triple


class Mixer(Section):
    """Thruster commands per unit of demand, axis by axis."""

    surge: tuple[float, ...]
    sway: tuple[float, ...]
    heave: tuple[float, ...]
    roll: tuple[float, ...]
    pitch: tuple[float, ...]
    yaw: tuple[float, ...]


class ThrusterSet(Section):
    """All thrusters, their common force curve, and the mixer from demands to commands."""

    command_limit: PositiveFloat
    force_curve: ForceCurve
    units: tuple[Thruster, ...] = Field(min_length=1)
    mixer: Mixer

    def mixing(self) -> Array:
        """Matrix (n, 6) from demands to thruster commands."""
        return np.array([getattr(self.mixer, axis) for axis in AXES], dtype=float).T


class Vehicle(Section):
    """A vehicle file, as in conf/vehicle/."""

    name: str
    fluid: Fluid
    rigid_body: DryVehicle
    hydrodynamics: Hydrodynamics
    thrusters: ThrusterSet

    def effects(self) -> tuple[Effect, ...]:
        """The nominal physics as effects: what "the model" is until others are added."""
        dry, water = self.rigid_body, self.hydrodynamics
        place = dict(zip("xyz", dry.center_of_gravity, strict=True))
        buoyancy = self.fluid.density * self.fluid.gravity * dry.displaced_volume
        return (
            RigidBody(mass=dry.mass, **dry.inertia.model_dump(), **place),
            AddedMass(**_by_axis(water.added_mass)),
            LinearDamping(**_by_axis(water.linear_damping)),
            QuadraticDamping(**_by_axis(water.quadratic_damping)),
            NetBuoyancy(force=buoyancy),
            BuoyancyCenter(**dict(zip("xyz", dry.center_of_buoyancy, strict=True))),
            Thrusters(self.thrusters),
        )


def _by_axis(values: Six) -> dict[str, float]:
    return dict(zip(AXES, values, strict=True))


class Thrusters(Coefficients):
    """Thrusters with a static force curve: where they push, and how hard for a command."""

    id = "thrusters"
    listed = False
    equation = r"\tau = B F,\quad F_i = \sum_k a_k c_i^{2k+1}"
    neglects = "dynamics, inflow, reaction torque, interaction"
    source = "the vehicle file"
    parameters = ()

    def __init__(self, layout: ThrusterSet) -> None:
        super().__init__()
        self.layout = layout
        self.directions = np.array([unit.direction for unit in layout.units], dtype=float)
        self.positions = np.array([unit.position for unit in layout.units], dtype=float)
        self.spin = np.array([unit.spin for unit in layout.units], dtype=float)
        self.mixing = layout.mixing()

    def enter(self, body: Body) -> None:
        """Set the allocation matrix B (6, n): each column is direction and moment (eq. 9.77)."""
        moments = np.cross(self.positions, self.directions)
        body.B = np.hstack([self.directions, moments]).T.copy()
        body.directions, body.spin = self.directions, self.spin

    def static_force(self, command: Array) -> Array:
        """Force in N of commands (..., n) in [-1, 1]."""
        force, power = np.zeros_like(command), command
        for a in self.layout.force_curve.odd_polynomial:
            force = force + a * power
            power = power * command * command
        return force


def known_vehicle(name: str) -> Path | None:
    """The file of a vehicle that has a name, None if there is none."""
    return conf_file(f"vehicle/{name}.yaml")


def load_vehicle(name: str, beside: Path | None = None) -> Vehicle:
    """Load a vehicle by its name in conf/vehicle/, or by a path (relative to `beside`).

    Raises:
        BadInput: no such vehicle, or its file does not describe one.
    """
    path = known_vehicle(name) or (beside or Path()) / name
    if not path.is_file():
        raise BadInput(
            f"unknown vehicle '{name}'",
            where=beside or "vehicle",
            expected="a name in conf/vehicle/ or the path of a vehicle file",
            remedy=nearest(name, conf_names("vehicle")),
        )
    vehicle = checked(Vehicle, read_yaml(path), path)
    check_layout(vehicle, path)
    return vehicle


def check_layout(vehicle: Vehicle, path: Path) -> None:
    """Refuse thrusters and a mixer that do not fit together.

    Raises:
        BadInput: a mixer row of another length, or a direction that is not a unit vector.
    """
    count = len(vehicle.thrusters.units)
    for axis in AXES:
        row = getattr(vehicle.thrusters.mixer, axis)
        if len(row) != count:
            raise BadInput(
                f"mixer.{axis} has {len(row)} numbers for {count} thrusters",
                where=path,
                expected="one number per thruster",
                remedy="Complete that row.",
            )
    for unit in vehicle.thrusters.units:
        length = float(np.linalg.norm(unit.direction))
        if abs(length - 1.0) > 0.01:
            raise BadInput(
                f"thruster {unit.name} has a direction of length {length:.3f}",
                where=path,
                expected="a unit vector",
                remedy="Divide the direction by its length.",
            )
