"""Read OptiTrack Motive's csv export of format version 1.2x."""

import csv
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.files import read_text
from rovsim.core.rotations import conjugate, multiply, rotate
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.attitudes import check_unit_length, finite_rows, unit_quaternions
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.header_times import reads_time
from rovsim.measurement.recording.readers import FileAxes, MocapReader, choose_body
from rovsim.measurement.recording.repairs import MotionRepairs
from rovsim.measurement.recording.signature import FileSignature, head_lines
from rovsim.measurement.recording.tables.delimited import split_lines, without_cut_line
from rovsim.measurement.recording.tables.numbers import numbers
from rovsim.measurement.recording.tables.times import times

RE_EXPORT = (
    "In Motive: Edit, Export Tracking Data, CSV, with Rigid Bodies, header information on, "
    "coordinates Global."
)
METRES = {"meters": 1.0, "centimeters": 1e-2, "millimeters": 1e-3}
EULER_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
MAX_HEADER_LINES = 30  # above the data that can be column names
# A quarter turn about x takes (x, up, z) to (x, -z, up): y_up to z_up, and fur to flu.
QUARTER_TURN_X = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
CHECK_UP_AXIS = (
    "Motive exports y up unless its Axis Convention was changed, and the file does not say: check "
    "'mocap.world_axes' (y_up) and 'mocap.body_axes' (fur)."
)


@dataclass(frozen=True)
class Layout:
    """Where things stand in a file.

    Attributes:
        header: header values by key, in lower case.
        line: index of the line of column names.
        names: the column names.
        bodies: indices of the columns of rotation and of position, by rigid body.
    """

    header: dict[str, str]
    line: int
    names: list[str]
    bodies: dict[str, tuple[list[int], list[int]]]


def read_motive(path: Path, mocap: Mocap) -> Export:
    """Read one rigid body; `y_up` and `fur` are turned into `z_up` and `flu` here.

    Raises:
        BadInput: not a Motive export, or no such body in it; names the line and the column.
    """
    text = read_text(path)
    lines = text.split("\n")
    layout = _layout(path, lines)
    rotation_columns, position_columns = _body(path, layout, mocap.body)
    rows = split_lines(path, lines, layout.line, layout.names, ",", ended=text.endswith("\n"))
    table, cut_lines = without_cut_line(rows, [*rotation_columns, *position_columns])
    time = times(table, _time_column(path, layout))
    position = numbers(table, position_columns) * _metres(path, layout)
    angles = numbers(table, rotation_columns)
    attitude, valid = _attitude(path, layout, angles)
    doubts: tuple[str, ...] = ()
    if angles.shape[1] == 4:
        doubts = check_unit_length(angles, lambda row: f"{path}, line {table.numbers[row]}")
    valid &= finite_rows(position)
    position, attitude = _upright(position, attitude, mocap)
    notes = doubts if mocap.world_axes == "y_up" else (*doubts, CHECK_UP_AXIS)
    repairs = MotionRepairs(cut_lines=cut_lines)
    return Export(time, position, attitude, valid, _rate(layout), repairs=repairs, notes=notes)


def _upright(position: Array, attitude: Array, mocap: Mocap) -> tuple[Array, Array]:
    """Turn positions (n, 3) from y_up to z_up, and attitudes (n, 4) also from fur to flu.

    Only what the campaign states as `y_up` or `fur` is turned.
    """
    if mocap.world_axes == "y_up":
        position, attitude = rotate(QUARTER_TURN_X, position), multiply(QUARTER_TURN_X, attitude)
    if mocap.body_axes == "fur":
        attitude = multiply(attitude, conjugate(QUARTER_TURN_X))
    return position, attitude


def _attitude(path: Path, layout: Layout, values: Array) -> tuple[Array, Array]:
    """Make quaternions (n, 4), scalar first, of columns x, y, z, w or of Euler angles in degrees.

    Returns:
        The quaternions, and which of them (n,) are valid.
    """
    kind = layout.header.get("rotation type", "Quaternion").strip()
    if values.shape[1] == 4 and kind.lower() == "quaternion":
        return unit_quaternions(values[:, [3, 0, 1, 2]])
    if values.shape[1] == 3 and kind.upper() in EULER_ORDERS:
        valid = finite_rows(values)
        # intrinsic angles: each about the axis that the earlier ones have turned (OptiTrack)
        order = ["XYZ".index(axis) for axis in kind.upper()]
        angles = np.where(valid[:, None], values, 0.0)[:, order]
        rotation = scipy.spatial.transform.Rotation.from_euler(kind.upper(), angles, degrees=True)
        return rotation.as_quat(scalar_first=True), valid
    raise BadInput(
        f"Rotation Type is '{kind}' with {values.shape[1]} columns",
        where=path,
        expected=f"Quaternion, or Euler angles in an order such as {EULER_ORDERS[0]}",
        remedy=RE_EXPORT,
    )


def _layout(path: Path, lines: list[str]) -> Layout:
    """Find the columns by the line that starts with Frame and the lines of names above it."""
    top = [next(csv.reader(io.StringIO(line)), []) for line in lines[:MAX_HEADER_LINES]]
    cells = [[cell.strip() for cell in row] for row in top]
    name_line = next((n for n, row in enumerate(cells) if row and row[0] == "Frame"), None)
    header = _header(path, cells, lines)
    kinds = next((n for n, row in enumerate(cells[:name_line]) if "Rigid Body" in row[2:]), None)
    if name_line is None or kinds is None or kinds + 2 > name_line - 1:
        raise BadInput(
            f"no columns of a rigid body (format version {header.get('format version', '?')})",
            where=path,
            expected="lines of types, names, Rotation and Position above the line 'Frame, Time'",
            remedy=RE_EXPORT,
        )
    bodies = _bodies(cells[kinds], cells[kinds + 1], cells[name_line - 1])
    return Layout(header, name_line, cells[name_line], bodies)


def _header(path: Path, cells: list[list[str]], lines: list[str]) -> dict[str, str]:
    if not any(line.strip() for line in lines):
        raise BadInput("the file is empty", where=path, expected="a Motive csv", remedy=RE_EXPORT)
    fields = cells[0]
    if not fields or fields[0] != "Format Version":
        raise BadInput(
            f"the first line starts with {(fields or [''])[0]!r}",
            where=f"{path}, line 1",
            expected="'Format Version', as Motive writes with its header information",
            remedy=RE_EXPORT,
        )
    header = {key.lower(): value for key, value in zip(fields[::2], fields[1::2], strict=False)}
    space = header.get("coordinate space", "Global")
    if space.lower() != "global":
        raise BadInput(
            f"Coordinate Space is '{space}'",
            where=f"{path}, line 1",
            expected="Global: positions in the tank, not in another body",
            remedy=RE_EXPORT,
        )
    return header


def _bodies(
    kinds: list[str], names: list[str], what: list[str]
) -> dict[str, tuple[list[int], list[int]]]:
    bodies: dict[str, tuple[list[int], list[int]]] = {}
    for column, (kind, name, meaning) in enumerate(zip(kinds, names, what, strict=False)):
        if kind == "Rigid Body" and meaning in ("Rotation", "Position"):
            bodies.setdefault(name, ([], []))[meaning == "Position"].append(column)
    return bodies


def _body(path: Path, layout: Layout, name: str) -> tuple[list[int], list[int]]:
    body = choose_body(tuple(layout.bodies), name, path)
    rotation, position = layout.bodies[body]
    if len(position) != 3 or len(rotation) not in (3, 4):
        raise BadInput(
            f"{len(rotation)} columns of rotation and {len(position)} of position for '{body}'",
            where=path,
            expected="four of a quaternion or three angles, and three of position",
            remedy=RE_EXPORT,
        )
    return rotation, position


def _time_column(path: Path, layout: Layout) -> int:
    for name in ("Time (Seconds)", "Time"):
        if name in layout.names:
            return layout.names.index(name)
    raise BadInput(
        f"no column 'Time (Seconds)', but {', '.join(layout.names[:3])}",
        where=f"{path}, line {layout.line + 1}",
        expected="the time of every frame",
        remedy=RE_EXPORT,
    )


def _metres(path: Path, layout: Layout) -> float:
    unit = layout.header.get("length units", "Meters")
    if unit.lower() not in METRES:
        raise BadInput(
            f"Length Units are '{unit}'",
            where=f"{path}, line 1",
            expected=f"one of {', '.join(METRES)}",
            remedy=RE_EXPORT,
        )
    return METRES[unit.lower()]


def _rate(layout: Layout) -> float | None:
    try:
        rate = float(layout.header.get("export frame rate", ""))
    except ValueError:
        return None
    return rate if np.isfinite(rate) and rate > 0 else None


def body_names(path: Path) -> list[str]:
    """List the rigid bodies of an export.

    Raises:
        BadInput: not a Motive export.
    """
    return list(_layout(path, read_text(path).split("\n")).bodies)


def _recognised(head: bytes) -> bool:
    return any(line.lstrip('"').startswith("Format Version") for line in head_lines(head)[:1])


MOCAP_READER = MocapReader(
    "motive_csv",
    "a Motive export",
    read_motive,
    (FileSignature(_recognised),),
    body_names,
    FileAxes(("z_up", "ned", "y_up"), ("flu", "frd", "fur")),
    start=reads_time(
        r"Capture Start Time,(\d{4}-\d\d-\d\d \d\d\.\d\d\.\d\d)(\.\d+)?( [AP]M)",
        "%Y-%m-%d %I.%M.%S %p",
    ),
)
