"""Read Qualisys Track Manager's 6DOF export (tab separated, millimetres)."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.files import read_text
from rovsim.core.rotations import from_matrix
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.attitudes import finite_rows, orthonormal
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.header_times import reads_time
from rovsim.measurement.recording.readers import MocapReader, choose_body
from rovsim.measurement.recording.repairs import MotionRepairs
from rovsim.measurement.recording.signature import FileSignature, head_lines
from rovsim.measurement.recording.tables.delimited import Lines, split_lines, without_cut_line
from rovsim.measurement.recording.tables.numbers import numbers
from rovsim.measurement.recording.tables.times import times

POSITION = ["X", "Y", "Z"]
ROTATION = [f"Rot[{k}]" for k in range(9)]
RE_EXPORT = "In QTM: File, Export, To TSV, with data type 6D and the column header included."


@dataclass(frozen=True)
class Layout:
    """Where things stand in a file.

    Attributes:
        header: header values by key.
        line: index of the line of column names.
        names: the column names.
        bodies: indices of columns by name, for each rigid body.
    """

    header: dict[str, list[str]]
    line: int
    names: list[str]
    bodies: dict[str, dict[str, int]]


def read_qtm(path: Path, mocap: Mocap) -> Export:
    """Read one rigid body; its attitude comes from the rotation matrix, not the Euler angles.

    Raises:
        BadInput: not a QTM export, or no such body in it; names the line and the column.
    """
    text = read_text(path)
    lines = text.split("\n")
    layout = _layout(path, lines)
    body = layout.bodies[
        choose_body(tuple(layout.bodies), mocap.body, f"{path}, line {layout.line + 1}")
    ]
    rows = split_lines(path, lines, layout.line, layout.names, "\t", ended=text.endswith("\n"))
    places = [body[name] for name in [*POSITION, *ROTATION]]
    table, cut_lines = without_cut_line(_without_events(rows), places)
    rate = _rate(path, layout)
    time = _time(table, layout, rate)
    values = numbers(table, places)
    residual = numbers(table, [body["Residual"]]) if "Residual" in body else None
    # the matrix is written column by column: element 3 c + r is row r, column c
    R = values[:, 3:].reshape(-1, 3, 3).transpose(0, 2, 1)
    visible = finite_rows(values) & values.any(axis=1)
    if residual is not None:
        visible &= ~(residual[:, 0] < 0.0)
    valid = visible & orthonormal(R)
    attitude = from_matrix(np.where(valid[:, None, None], R, np.eye(3)))
    repairs = MotionRepairs(cut_lines=cut_lines, bad_rotations=int(np.sum(visible & ~valid)))
    return Export(time, values[:, :3] * 1e-3, attitude, valid, rate, repairs=repairs)


def _layout(path: Path, lines: list[str]) -> Layout:
    header: dict[str, list[str]] = {}
    for number, line in enumerate(lines):
        cells = [cell.strip() for cell in line.rstrip("\t").split("\t")]
        if "Rot[0]" in cells or any(cell.endswith(" Rot[0]") for cell in cells):
            _check_kind(path, header)
            names = header.get("BODY_NAMES", [])
            return Layout(header, number, cells, _bodies(path, number, cells, names))
        header.setdefault(cells[0], cells[1:])
        if cells[0] in ("Frame", "Time") or _is_data(cells):
            break
    _check_kind(path, header)
    raise BadInput(
        "no line of column names with X, Y, Z and Rot[0] to Rot[8]"
        if any(line.strip() for line in lines)
        else "the file is empty",
        where=path,
        expected="a QTM 6DOF export",
        remedy=RE_EXPORT,
    )


def _is_data(cells: list[str]) -> bool:
    try:
        return len(cells) > 3 and all(np.isfinite(float(cell)) for cell in cells[:4])
    except ValueError:
        return False


def _check_kind(path: Path, header: dict[str, list[str]]) -> None:
    kind = " ".join(header.get("DATA_INCLUDED", ["6D"]))
    if "6D" not in kind:
        raise BadInput(
            f"the export holds {kind} data (marker positions), not rigid bodies",
            where=f"{path}, DATA_INCLUDED",
            expected="DATA_INCLUDED 6D",
            remedy=RE_EXPORT,
        )


def _bodies(
    path: Path, line: int, cells: list[str], body_names: list[str]
) -> dict[str, dict[str, int]]:
    """Find the columns of every body, by name. A body starts at its '<Body> X' column."""
    starts = [n for n, cell in enumerate(cells) if cell == "X" or cell.endswith(" X")]
    bodies: dict[str, dict[str, int]] = {}
    if not starts:
        raise _no_columns(path, line, POSITION[:1], "any body")
    for order, (start, end) in enumerate(zip(starts, [*starts[1:], len(cells)], strict=True)):
        name = cells[start][:-1].strip()
        if not name:
            name = body_names[order] if order < len(body_names) else f"body {order + 1}"
        columns = {cells[n].removeprefix(f"{name} "): n for n in range(start, end)}
        missing = [column for column in [*POSITION, *ROTATION] if column not in columns]
        if missing:
            raise _no_columns(path, line, missing, f"the body '{name}'")
        bodies[name] = columns
    return bodies


def _no_columns(path: Path, line: int, missing: list[str], body: str) -> BadInput:
    return BadInput(
        f"no column {', '.join(missing)} for {body}",
        where=f"{path}, line {line + 1}",
        expected="X, Y, Z and Rot[0] to Rot[8] for every body",
        remedy=RE_EXPORT,
    )


def _without_events(table: Lines) -> Lines:
    keep = [n for n, row in enumerate(table.rows) if row.split("\t", 1)[0].strip() != "EVENT"]
    rows, line_numbers = [table.rows[n] for n in keep], [table.numbers[n] for n in keep]
    return replace(table, rows=rows, numbers=line_numbers)


def _rate(path: Path, layout: Layout) -> float | None:
    text = "".join(layout.header.get("FREQUENCY", [])[:1])
    try:
        rate = float(text) if text else None
    except ValueError:
        rate = 0.0
    if rate is None or (np.isfinite(rate) and rate > 0):
        return rate
    raise BadInput(
        f"FREQUENCY is {text!r}",
        where=path,
        expected="the capture rate in Hz",
        remedy="Correct that header line, with a decimal point.",
    )


def _time(table: Lines, layout: Layout, rate: float | None) -> Array:
    """Times (n,) s of the lines. QTM counts frames from 1, and frame 1 is time 0."""
    if "Time" in layout.names:
        return times(table, layout.names.index("Time"))
    if rate is None:
        raise BadInput(
            "neither a Time column nor a FREQUENCY line",
            where=table.path,
            expected="one of them",
            remedy="Export again with the time column, or add the line FREQUENCY <Hz>.",
        )
    if "Frame" in layout.names:
        return (times(table, layout.names.index("Frame")) - 1.0) / rate
    return np.arange(len(table)) / rate


def body_names(path: Path) -> list[str]:
    """List the rigid bodies of an export.

    Raises:
        BadInput: not a QTM export.
    """
    return list(_layout(path, read_text(path).split("\n")).bodies)


def _recognised(head: bytes) -> bool:
    lines = head_lines(head)
    headed = any(re.match(r"(NO_OF_FRAMES|FILE_VERSION)\b", line) for line in lines[:1])
    return headed or any("Rot[0]" in line for line in lines[:40])


MOCAP_READER = MocapReader(
    "qtm_tsv",
    "a QTM export",
    read_qtm,
    (FileSignature(_recognised),),
    body_names,
    start=reads_time(
        r"^TIME_STAMP\t(\d{4}-\d\d-\d\d, \d\d:\d\d:\d\d)(\.\d+)?", "%Y-%m-%d, %H:%M:%S"
    ),
)
