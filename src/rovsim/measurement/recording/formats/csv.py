"""Measured channels in a csv file whose column names carry their units, as `time_s, x_m, …`."""

import re
from dataclasses import dataclass
from difflib import get_close_matches
from functools import partial
from pathlib import Path
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.core.rotations import from_euler
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.attitudes import check_unit_length, finite_rows, unit_quaternions
from rovsim.measurement.recording.channels import Channel, measured
from rovsim.measurement.recording.csv_checks import (
    ANGULAR,
    LINEAR,
    POSITION,
    check_plausible,
    doubt_order,
    without_fillers,
)
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.readers import MocapReader
from rovsim.measurement.recording.repairs import MotionRepairs
from rovsim.measurement.recording.signature import FileSignature, head_lines
from rovsim.measurement.recording.tables.delimited import (
    Lines,
    csv_lines,
    is_table,
    without_cut_line,
)
from rovsim.measurement.recording.tables.named_columns import column_places
from rovsim.measurement.recording.tables.numbers import numbers
from rovsim.measurement.recording.tables.times import times

EULER = ["roll_rad", "pitch_rad", "yaw_rad"]  # R = Rz(yaw) Ry(pitch) Rx(roll)
QUATERNION = ["qw", "qx", "qy", "qz"]
EXTRA_COLUMNS = {  # kind of channel -> columns, beside poses and velocities
    "depth": ["depth_m"],
    "specific_force": ["ax_m_s2", "ay_m_s2", "az_m_s2"],
    "voltage": ["voltage_v"],
}
KNOWN_COLUMNS = [
    *POSITION,
    *EULER,
    *QUATERNION,
    *LINEAR,
    *ANGULAR,
    *(n for c in EXTRA_COLUMNS.values() for n in c),
]
# In at least this share of the lines with a position or an attitude, both must be given to count as
# full poses; likewise, poses and velocities must share lines for velocities to count as bin means.
MIN_SHARED_LINES = 0.5
NEAR_ZERO = 0.5  # m, rad: more than a vehicle moves from one line to the next
MIN_NAME_SIMILARITY = 0.75  # 'depth' is near 'depth_m', a demand 'pitch' not near 'pitch_rad'


@dataclass(frozen=True, eq=False)
class CsvColumns:
    """Columns of numbers (n,) by name, beside the times (n,) s of their lines."""

    time: Array
    values: Mapping[str, Array]

    def of(self, names: Sequence[str]) -> Array:
        """Values (n, c) of c columns by name; NaN for columns that the file has not."""
        missing = np.full(len(self.time), np.nan)
        return np.stack([self.values.get(name, missing) for name in names], axis=1)


def read_csv(path: Path, mocap: Mocap) -> Export:
    """Read poses, where position and attitude share their lines, and any other channel.

    Raises:
        BadInput: the file cannot be read so; names the line and the column.
    """
    lines = csv_lines(path)
    names = _known_columns(lines)
    places = column_places(path, lines.names, ["time_s", *names])
    table, cut_lines = without_cut_line(lines, places)
    values = numbers(table, places[1:])
    values, filled = without_fillers(names, values)
    zeros = _find_zeros(names, values)
    poses = np.isin(names, [*POSITION, *EULER])
    values[np.ix_(zeros, poses)] = np.nan
    columns = CsvColumns(times(table, places[0]), dict(zip(names, values.T, strict=True)))
    check_plausible(path, columns.time, columns.values)
    notes = _near_misses(lines.names) + filled + _note_zeros(int(zeros.sum()))
    if "qw" in names:
        notes += check_unit_length(columns.of(QUATERNION), partial(_quaternion_at, table))
    return _export(columns, mocap, MotionRepairs(cut_lines=cut_lines), notes)


def _quaternion_at(table: Lines, row: int) -> str:
    return f"{table.path}, line {table.numbers[row]}, columns {', '.join(QUATERNION)}"


def _find_zeros(names: list[str], values: Array) -> Array:
    """Mask (n,) of lines whose pose is all zeros: the tracker did not see the body.

    Zeros at the start count as poses if the next pose is close to zero, as where motion is measured
    from the first line. Nothing is masked unless two coordinates and an angle were measured.
    """
    is_position, is_angle = np.isin(names, POSITION), np.isin(names, EULER)
    if is_position.sum() < 2 or not is_angle.any() or not len(values):
        return np.zeros(len(values), bool)
    pose = values[:, is_position | is_angle]
    zeros = (pose == 0.0).all(axis=1)
    start = int(np.argmin(zeros)) if not zeros.all() else len(zeros)
    if start == len(zeros) or np.nanmax(np.abs(pose[start]), initial=0.0) < NEAR_ZERO:
        zeros[:start] = False
    return zeros


def _note_zeros(count: int) -> tuple[str, ...]:
    return (f"{count} lines with a pose of zeros count as not found.",) if count else ()


def _export(
    columns: CsvColumns, mocap: Mocap, repairs: MotionRepairs, notes: tuple[str, ...]
) -> Export:
    position, nu = columns.of(POSITION), columns.of([*LINEAR, *ANGULAR])
    quaternions = "qw" in columns.values
    angles = columns.of(QUATERNION if quaternions else EULER)
    notes += doubt_order(angles) if quaternions else ()
    posed = finite_rows(position, angles)
    channels = {
        kind: measured(columns.time, columns.of(names)) for kind, names in EXTRA_COLUMNS.items()
    }
    nonempty = np.isfinite(np.hstack([position, angles])).any(axis=1)
    if not posed.any() or posed.sum() < MIN_SHARED_LINES * nonempty.sum():
        channels |= _apart(columns, position, angles) | _velocities(columns, nu)
        return Export.of_channels(channels, repairs, notes)
    binned = _means(posed, nu, mocap)
    if not binned:
        channels |= _velocities(columns, nu)
        notes += _instant(channels, mocap)
    attitude, valid = _attitude(angles)
    valid &= finite_rows(position, *([nu] if binned else []))
    frame = _frames(columns.time, nonempty, channels)
    return Export(
        columns.time[frame],
        position[frame],
        attitude[frame],
        valid[frame],
        nu=nu[frame] if binned else None,
        repairs=repairs,
        channels=channels,
        notes=notes,
    )


def _means(posed: Array, nu: Array, mocap: Mocap) -> bool:
    """Whether the velocities (n, 6) are taken for means over the time from one pose to the next.

    They are if both are complete in at least half of the lines with poses and in half of those with
    any velocity, unless the campaign says that velocities are instantaneous.
    """
    if mocap.velocity == "instant":
        return False
    nonempty = np.isfinite(nu).any(axis=1)
    complete = finite_rows(nu) & posed
    return bool(
        complete.any() and complete.sum() >= MIN_SHARED_LINES * max(nonempty.sum(), posed.sum())
    )


def _instant(channels: Mapping[str, Channel], mocap: Mocap) -> tuple[str, ...]:
    has_velocity = any(len(channels[kind].time) for kind in ("velocity", "rates"))
    if mocap.velocity == "instant" or not has_velocity:
        return ()
    return (
        "The body velocities do not come with every pose, all six of them: they are read as "
        "values at their times, not as means. 'mocap.velocity: instant' says so.",
    )


def _frames(time: Array, partly: Array, channels: Mapping[str, Channel]) -> Array:
    """Mask (n,) of lines that are frames of the poses, not written by another sensor alone."""
    return partly | ~np.isin(time, np.concatenate([c.time for c in channels.values()]))


def _apart(columns: CsvColumns, position: Array, angles: Array) -> dict[str, Channel]:
    """Make channels of position and attitude; attitudes with missing angles become `euler`."""
    attitude, valid = _attitude(angles)
    channels = {
        "position": measured(columns.time, position),
        "attitude": Channel(columns.time[valid], attitude[valid]),
    }
    if angles.shape[1] == 3:
        incomplete = np.where(valid[:, None], np.nan, angles)
        channels["euler"] = measured(columns.time, incomplete)
    return channels


def _velocities(columns: CsvColumns, nu: Array) -> dict[str, Channel]:
    return {
        "velocity": measured(columns.time, nu[:, :3]),
        "rates": measured(columns.time, nu[:, 3:]),
    }


def _attitude(values: Array) -> tuple[Array, Array]:
    """Turn Euler angles (n, 3) or quaternions (n, 4) into unit quaternions; and which are valid."""
    if values.shape[1] == 4:
        return unit_quaternions(values)
    valid = finite_rows(values)
    return from_euler(*np.where(valid[:, None], values, 0.0).T), valid


def _known_columns(lines: Lines) -> list[str]:
    """List the columns of measured channels in the file.

    Raises:
        BadInput: there is none, or a quaternion lacks one of its components.
    """
    if any(name in lines.names for name in QUATERNION):
        column_places(lines.path, lines.names, ["time_s", *QUATERNION])
    names = [name for name in KNOWN_COLUMNS if name in lines.names]
    if not names:
        raise BadInput(
            f"no column of a measured channel, but {', '.join(lines.names)}",
            where=lines.path,
            expected=f"time_s and some of {', '.join(KNOWN_COLUMNS)}",
            remedy="Name the columns with their units; docs/formats.md lists them.",
        )
    return names


def _near_misses(names: list[str]) -> tuple[str, ...]:
    """Sentences about unread columns whose names resemble those of a channel."""
    missing = [name for name in KNOWN_COLUMNS if name not in names]
    matches = {
        name: close[0]
        for name in names
        if name not in KNOWN_COLUMNS
        and name != "time_s"
        and (close := get_close_matches(name, missing, n=1, cutoff=MIN_NAME_SIMILARITY))
    }
    return tuple(
        f"The column '{name}' is not read: was '{channel}' meant?"
        for name, channel in matches.items()
    )


def _recognised(head: bytes) -> bool:
    lines = head_lines(head)
    return len(lines) > 1 and (bool(re.search(r"[,;\t]", lines[0])) or is_table(head))


MOCAP_READER = MocapReader(
    "csv", "a csv file", read_csv, (FileSignature(_recognised),), general=True
)
