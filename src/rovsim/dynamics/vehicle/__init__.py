"""What a vehicle file says, and the nominal effects it stands for.

curves               command -> force of one thruster
thrusters            where thrusters push, and in which direction; some turn
hydrodynamics        added mass and damping, as six numbers or as a matrix
cross_flow           forces of products of velocities, named as by SNAME
surfaces             rudders and fins
file                 the whole file
check                checks that the parts of a vehicle fit together
implausible_numbers  finds values that seem to be in another unit
load                 loads a vehicle by its name, or from a file
"""

from rovsim.dynamics.vehicle.file import Vehicle
from rovsim.dynamics.vehicle.load import (
    build_vehicle,
    default_vehicle,
    known_vehicle,
    load_vehicle,
    vehicle_file,
)
from rovsim.dynamics.vehicle.surfaces import Surfaces
from rovsim.dynamics.vehicle.thrusters import Thrusters

__all__ = [
    "Surfaces",
    "Thrusters",
    "Vehicle",
    "build_vehicle",
    "default_vehicle",
    "known_vehicle",
    "load_vehicle",
    "vehicle_file",
]
