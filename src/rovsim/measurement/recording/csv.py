"""Poses in a csv file whose column names carry their units, as in `time_s, x_m, … yaw_rad`."""

from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.files import read_text
from rovsim.core.rotations import from_euler, normalized
from rovsim.measurement.campaign import Mocap
from rovsim.measurement.recording.readers import Export, finite_rows, mocap_reader
from rovsim.measurement.recording.table import (
    Lines,
    column_places,
    numbers,
    split_lines,
    times,
    without_cut_line,
)

POSITION = ["x_m", "y_m", "z_m"]
EULER = ["roll_rad", "pitch_rad", "yaw_rad"]  # R = Rz(yaw) Ry(pitch) Rx(roll)
QUATERNION = ["qw", "qx", "qy", "qz"]
VELOCITY = ["u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s"]


@mocap_reader("csv")
def read_csv(path: Path, mocap: Mocap) -> Export:
    """Read poses, and the body velocities where all six are given.

    Raises:
        BadInput: not such a file; names the line and the column.
    """
    lines = csv_lines(path)
    attitude_names = QUATERNION if any(q in lines.names for q in QUATERNION) else EULER
    velocity_names = _velocity_names(lines)
    wanted = ["time_s", *POSITION, *attitude_names, *velocity_names]
    places = column_places(path, lines.names, wanted)
    table, cut = without_cut_line(lines, places)
    time = times(table, places[0])
    position = numbers(table, places[1:4])
    end = 4 + len(attitude_names)
    attitude, found = _attitude(numbers(table, places[4:end]))
    nu = numbers(table, places[end:]) if velocity_names else None
    found &= finite_rows(position, *([] if nu is None else [nu]))
    return Export(time, position, attitude, found, nu=nu, counts={"cut_lines": cut})


def csv_lines(path: Path) -> Lines:
    """Lines of a csv file below its line of column names.

    Raises:
        BadInput: the file is empty, or is not separated by commas.
    """
    text = read_text(path)
    lines = text.split("\n")
    header = next((n for n, line in enumerate(lines) if line.strip()), None)
    if header is None:
        raise BadInput(
            "the file is empty",
            where=path,
            expected="a line of column names and lines of numbers",
            remedy="Export the run again.",
        )
    names = [cell.strip().strip('"') for cell in lines[header].rstrip(" ,").split(",")]
    for separator, word in ((";", "semicolons"), ("\t", "tabs")):
        if len(names) == 1 and separator in lines[header]:
            raise BadInput(
                f"the columns are separated by {word}",
                where=f"{path}, line {header + 1}",
                expected="commas between columns and decimal points",
                remedy="Save it again with commas.",
            )
    return split_lines(path, lines, header, names, ",", ended=text.endswith("\n"))


def _attitude(values: Array) -> tuple[Array, Array]:
    """Unit quaternions (n, 4) of Euler angles (n, 3) or quaternions (n, 4), and where found."""
    found = finite_rows(values)
    if values.shape[1] == 3:
        return from_euler(*np.where(found[:, None], values, 0.0).T), found
    length = np.linalg.norm(values, axis=1)
    # far from unit length it is no rotation: trackers write zeros where the body was not found
    found &= np.abs(length - 1.0) < 0.1
    return normalized(np.where(found[:, None], values, [1.0, 0.0, 0.0, 0.0])), found


def _velocity_names(table: Lines) -> list[str]:
    given = [name for name in VELOCITY if name in table.names]
    if 0 < len(given) < len(VELOCITY):
        missing = ", ".join(name for name in VELOCITY if name not in given)
        raise BadInput(
            f"no column {missing}, but {', '.join(given)}",
            where=table.path,
            expected="all six body velocities or none",
            remedy="Add the missing columns, or remove the velocities.",
        )
    return given and VELOCITY
