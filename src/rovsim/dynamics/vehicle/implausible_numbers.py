"""Find implausible numbers in a vehicle file, which are most likely in another unit.

They only cause warnings: a file may describe a vehicle that was never built. Lengths are compared
with the vehicle's length, for which the edge of a cube of water of its mass is taken. Published
vehicles have radii of gyration of 0.2 to 2 times this length, and thrusters at most 5 times this
length away from CO.
"""

from typing import Iterator

import numpy as np

from rovsim.dynamics.vehicle.file import Vehicle

GRAVITY_RANGE = (1.0, 30.0)  # m/s2: from the Moon's to Jupiter's
DENSITY_RANGE = (500.0, 2000.0)  # kg/m3, of a liquid in which a vehicle swims
MAX_DENSITY_RATIO = 5.0  # times: mass over that of the displaced water; or less than 1/5
GYRATION_RANGE = (0.03, 10.0)  # times the vehicle's length
MAX_DISTANCE = 30.0  # times the vehicle's length


def doubt_units(vehicle: Vehicle) -> tuple[str, ...]:
    """Sentences about numbers that seem to be in another unit; empty where all are plausible."""
    doubts = [*_water(vehicle), *_weight(vehicle), *_inertia(vehicle), *_places(vehicle)]
    return tuple(f"Vehicle file, {sentence}" for sentence in doubts)


def _water(vehicle: Vehicle) -> Iterator[str]:
    """Yield implausible density and gravity."""
    density, gravity = vehicle.fluid.density, vehicle.fluid.gravity
    if not DENSITY_RANGE[0] <= density <= DENSITY_RANGE[1]:
        yield f"fluid.density: {density:g} is that of no water. In kg/m3?"
    if not GRAVITY_RANGE[0] <= gravity <= GRAVITY_RANGE[1]:
        yield f"fluid.gravity: {gravity:g}, and on Earth it is 9.8. In m/s2?"


def _weight(vehicle: Vehicle) -> Iterator[str]:
    """Yield an implausible ratio of the mass to that of the displaced water."""
    dry = vehicle.rigid_body
    if vehicle.floats or dry.displaced_volume is None:
        return
    if not DENSITY_RANGE[0] <= vehicle.density <= DENSITY_RANGE[1]:
        return  # `_water` reports that
    water = vehicle.density * dry.displaced_volume
    if not 1.0 / MAX_DENSITY_RATIO <= dry.mass / water <= MAX_DENSITY_RATIO:
        yield (
            f"rigid_body: a mass of {dry.mass:g} kg, and its displaced_volume holds {water:g} kg "
            "of water. In kg, and in m3?"
        )


def _inertia(vehicle: Vehicle) -> Iterator[str]:
    """Yield moments of inertia with an implausible radius of gyration."""
    dry, size = vehicle.rigid_body, _length(vehicle)
    for axis, name in {"roll": "Ixx", "pitch": "Iyy", "yaw": "Izz"}.items():
        moment = getattr(dry.inertia, name)
        if moment is None or axis not in vehicle.degrees_of_freedom:
            continue
        radius = float(np.sqrt(moment / dry.mass))
        if not GYRATION_RANGE[0] * size <= radius <= GYRATION_RANGE[1] * size:
            yield (
                f"rigid_body.inertia.{name}: {moment:g} with a mass of {dry.mass:g} is a radius of "
                f"gyration of {radius:.2g} m. In kg m2, and the mass in kg?"
            )


def _places(vehicle: Vehicle) -> Iterator[str]:
    """Yield places that are implausibly far from CO."""
    dry = vehicle.rigid_body
    positions = {
        "rigid_body.center_of_gravity": dry.center_of_gravity,
        "rigid_body.center_of_buoyancy": dry.center_of_buoyancy,
        **{f"thruster {unit.name}, position": unit.position for unit in vehicle.thrusters.units},
    }
    for name, position in positions.items():
        if position is not None and np.linalg.norm(position) > MAX_DISTANCE * _length(vehicle):
            yield f"{name}: {', '.join(f'{x:g}' for x in position)}. In m from CO?"


def _length(vehicle: Vehicle) -> float:
    """Edge of a cube of water of the vehicle's mass, m."""
    return float(np.cbrt(vehicle.dry_mass / 1000.0))
