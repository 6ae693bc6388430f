"""Check that the parts of a vehicle file are consistent with each other."""

from collections import Counter
from pathlib import Path
from typing import Iterator

import numpy as np

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput, nearest
from rovsim.dynamics.vehicle.file import Vehicle

UNIT_LENGTH_TOLERANCE = 0.01  # tolerance of the length of a unit vector
WEIGHT_AXES = ("heave", "roll", "pitch")  # axes on which weight and buoyancy act
Finding = tuple[str, str, str]  # found, expected, remedy


def check_vehicle(vehicle: Vehicle, where: Path | str) -> None:
    """Refuse a vehicle whose parts are not consistent.

    Args:
        vehicle: whose parts are checked.
        where: its file, for the message.

    Raises:
        BadInput: for the first fault.
    """
    for find in (_names, _mixer, _thrusters, _surfaces, _inertia, _buoyancy, _products):
        for fault, expected, remedy in find(vehicle):
            raise BadInput(fault, where=where, expected=expected, remedy=remedy)


def _names(vehicle: Vehicle) -> Iterator[Finding]:
    """Yield names that two command columns share, and a surface with the reserved name `all`."""
    for name, count in Counter(vehicle.command_columns).items():
        if count > 1:
            fault = f"{count} command columns are called {name}"
            yield fault, "a name of its own for each thruster and surface", "Rename one of them."
    if "all" in [surface.name for surface in vehicle.surfaces]:
        yield "a surface is called all", "another name: all means all of them", "Rename it."


def _mixer(vehicle: Vehicle) -> Iterator[Finding]:
    """Yield rows of the mixer without one number per thruster."""
    count, mixer = len(vehicle.thrusters.units), vehicle.thrusters.mixer
    for axis in AXES if mixer else ():
        row = getattr(mixer, axis)
        if len(row) != count:
            fault = f"mixer.{axis} has {len(row)} numbers for {count} thrusters"
            yield fault, "one number per thruster", "Complete that row."


def _thrusters(vehicle: Vehicle) -> Iterator[Finding]:
    """Yield thrusters with a bad direction or without a force curve."""
    for unit in vehicle.thrusters.units:
        length = float(np.linalg.norm(unit.direction))
        if abs(length - 1.0) > UNIT_LENGTH_TOLERANCE:
            fault = f"thruster {unit.name} has a direction of length {length:.3f}"
            yield fault, "a unit vector", "Divide the direction by its length."
        if unit.azimuth and abs(unit.direction[2]) > UNIT_LENGTH_TOLERANCE:
            fault = f"thruster {unit.name} turns about the z axis and points along {unit.direction}"
            yield (
                fault,
                "a direction in the plane of x and y",
                "Set z to 0, or take azimuth out.",
            )
        if not (unit.force_curve or vehicle.thrusters.force_curve):
            fault = f"thruster {unit.name} has no force_curve"
            yield fault, "thrusters.force_curve, or one of its own", "Add one."


def _surfaces(vehicle: Vehicle) -> Iterator[Finding]:
    """Yield surfaces with a bad normal, or in the wake of a thruster that cannot have one."""
    jets = [unit.name for unit in vehicle.thrusters.units if not unit.azimuth]
    for s in vehicle.surfaces:
        normal = np.array(s.normal)
        length = float(np.linalg.norm(normal))
        if abs(length - 1.0) > UNIT_LENGTH_TOLERANCE or abs(normal[0]) > 0.9:
            fault = f"surface {s.name} has the normal {s.normal}"
            yield fault, "a unit vector across the x axis", "Rudder: [0, 1, 0]; fin: [0, 0, -1]."
        if s.in_wake_of is not None and s.in_wake_of not in jets:
            fault = f"surface {s.name} is in the wake of '{s.in_wake_of}'"
            yield fault, "the name of a thruster that does not turn", nearest(s.in_wake_of, jets)


def _inertia(vehicle: Vehicle) -> Iterator[Finding]:
    """Yield moments of inertia that are missing for axes that move."""
    moments = {"roll": "Ixx", "pitch": "Iyy", "yaw": "Izz"}
    for axis, name in moments.items():
        if axis in vehicle.degrees_of_freedom and getattr(vehicle.rigid_body.inertia, name) is None:
            fault = f"'rigid_body.inertia.{name}' is missing"
            remedy = f"Add it, or leave {axis} out of degrees_of_freedom."
            yield fault, f"a value for it, since the vehicle moves in {axis}", remedy


def _buoyancy(vehicle: Vehicle) -> Iterator[Finding]:
    """Yield numbers of the buoyancy that are missing for a submerged vehicle."""
    if vehicle.floats or not set(WEIGHT_AXES) & set(vehicle.degrees_of_freedom):
        return
    for name in ("displaced_volume", "center_of_buoyancy"):
        if getattr(vehicle.rigid_body, name) is None:
            remedy = "Add it; what floats has a 'waterplane' and may do without."
            yield f"'rigid_body.{name}' is missing", f"a value for 'rigid_body.{name}'", remedy


def _products(vehicle: Vehicle) -> Iterator[Finding]:
    """Yield products of velocities that the file has in two places."""
    for name in vehicle.cross_flow:
        if name in vehicle.hydrodynamics.cross_flow:
            fault = f"'{name}' stands in cross_flow and in hydrodynamics.cross_flow"
            yield fault, "one value", "Remove one of them."
