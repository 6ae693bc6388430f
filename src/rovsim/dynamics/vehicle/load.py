"""Load vehicles by their names in conf/vehicle/, or from a file."""

from functools import cache
from pathlib import Path

from rovsim.core.errors import BadInput, nearest
from rovsim.core.schema import checked
from rovsim.core.shipped import conf_file, conf_names
from rovsim.core.yaml_files import read_yaml
from rovsim.dynamics.vehicle.check import check_vehicle
from rovsim.dynamics.vehicle.file import Vehicle


@cache
def default_vehicle() -> str:
    """Name of the vehicle to use where none is named, from conf/default_vehicle.yaml."""
    path = conf_file("default_vehicle.yaml")
    assert path is not None  # this file is part of rovsim
    return str(read_yaml(path)["vehicle"])


def known_vehicle(name: str) -> Path | None:
    """The file of a vehicle by its name in conf/vehicle/; None if there is none."""
    return conf_file(f"vehicle/{name}.yaml")


def vehicle_file(name: str, *, named_in: Path | None = None) -> Path:
    """Find the file of a vehicle.

    Args:
        name: a name in conf/vehicle/, or a path.
        named_in: the file that names the vehicle; a path is relative to its folder. None: relative
            to the working folder.

    Raises:
        BadInput: no such vehicle or file.
    """
    folder = named_in.parent if named_in else Path()
    path = known_vehicle(name) or folder / name
    if not path.is_file():
        raise BadInput(
            f"unknown vehicle '{name}'",
            where=f"{named_in}, key 'vehicle'" if named_in else "vehicle",
            expected="a name in conf/vehicle/ or the path of a vehicle file, relative to "
            + (str(folder) if named_in else "the working folder"),
            remedy=nearest(name, conf_names("vehicle")),
        )
    return path


def load_vehicle(name: str, *, named_in: Path | None = None) -> Vehicle:
    """Load a vehicle by its name in conf/vehicle/, or by a path (as `vehicle_file` finds it).

    Raises:
        BadInput: no such vehicle, or its file does not describe one.
    """
    path = vehicle_file(name, named_in=named_in)
    return build_vehicle(read_yaml(path), path)


def build_vehicle(content: object, where: Path | str) -> Vehicle:
    """Build and check the vehicle that the content of a file describes.

    Args:
        content: what was read from the file.
        where: the file, for messages.

    Raises:
        BadInput: the content does not describe a vehicle.
    """
    vehicle = checked(Vehicle, content, where)
    check_vehicle(vehicle, where)
    return vehicle
