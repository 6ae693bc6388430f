"""Find motions and commands in csv files."""

from dataclasses import replace
from pathlib import Path
from typing import Mapping

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.intake.survey.command_names import hint
from rovsim.intake.survey.contents import Contents, Track
from rovsim.intake.survey.csv_commands import find_commands
from rovsim.intake.survey.headings import rewritten
from rovsim.intake.survey.other_numbers import TimedColumns, find_numbers, read_others
from rovsim.intake.survey.repeats import check_unmixed, warn_of_repeats
from rovsim.intake.survey.sizes import Key, Unit, Units
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.formats.csv import KNOWN_COLUMNS, read_csv
from rovsim.measurement.recording.one_run import check_one_run
from rovsim.measurement.recording.tables.delimited import Lines, csv_lines
from rovsim.measurement.recording.tables.named_columns import TIME_COLUMN, no_time

EXPECTED_COMMANDS = "pulses of 800 to 2200 us, shares from -1 to 1, or columns named after axes"


class UnknownColumns(BadInput):
    """Columns of numbers that are neither a measured channel nor commands of a known kind."""


def look_into_csv(
    path: Path, scratch: Path, other_units: Mapping[Key, Unit] | None = None
) -> Contents:
    """Find out what a csv file holds.

    Args:
        path: of the file.
        scratch: folder for a copy under our names of columns, where the file has others.
        other_units: units that other files tell for columns of the same names.

    Raises:
        BadInput: the file holds neither a measured channel nor what looks like commands.
    """
    units = Units(other_units or {})
    place, notes = rewritten(path, scratch, units)
    try:
        return replace(_look(path, place, notes), units=units.settled)
    except BadInput as error:  # it names the copy, which is gone when the user reads it
        if place == path:
            raise
        where = error.where.replace(str(place), f"{path}, read as a copy with other columns")
        raise type(error)(
            error.found, where=where, expected=error.expected, remedy=error.remedy
        ) from None


def _look(path: Path, place: Path, notes: tuple[str, ...]) -> Contents:
    """Find out what the file at `place` holds, which is `path` or a copy of it."""
    lines = csv_lines(place)
    check_unmixed(replace(lines, path=path))
    channels = [name for name in lines.names if name in KNOWN_COLUMNS]
    other_columns = read_others(lines)
    drive = find_commands(lines, other_columns)
    if drive is not None:
        check_one_run(drive.time[np.isfinite(drive.value).any(axis=1)], path)
    unknown = "" if drive else _unknown(other_columns)
    if not channels and drive is None:
        raise _nothing(path, lines, unknown)
    tracks = (_track(place),) if channels else ()
    drives = () if drive is None else (drive,)
    original = None if place == path else path
    unread = tuple(
        name for name in lines.names if name and name not in (*KNOWN_COLUMNS, TIME_COLUMN)
    )
    doubts = warn_of_repeats(lines, [*channels, *(drive.bare if drive else ())])
    return Contents(
        place, "csv", tracks, drives, original, notes, unknown=unknown, unread=unread, doubts=doubts
    )


def _nothing(path: Path, lines: Lines, unknown: str) -> BadInput:
    """Make the error of a file without channels or commands.

    Args:
        path: the file as the user knows it.
        lines: of the file.
        unknown: its columns of unknown numbers, as `_unknown` lists them.
    """
    if TIME_COLUMN not in lines.names:
        return no_time(path, lines.names)
    if not unknown:
        return BadInput(
            f"no measured channel and nothing like commands in the columns {_some(lines.names)}",
            where=path,
            expected="time_s with positions, angles …, or with commands (docs/formats.md)",
            remedy="Name the columns with their units, or leave the file out.",
        )
    return UnknownColumns(
        f"no measured channel, and no commands that rovsim knows: {unknown}",
        where=path,
        expected=EXPECTED_COMMANDS,
        remedy="Convert them, name the columns after measurements with their units, or leave the "
        "file out.",
    )


def _some(names: list[str]) -> str:
    return ", ".join(names[:12]) + (" …" if len(names) > 12 else "")


def _track(path: Path) -> Track:
    mocap = Mocap(format="csv", world_axes="ned", body_axes="frd")
    return Track.of("", read_csv(path, mocap), path)


def _unknown(others: TimedColumns) -> str:
    """List columns of unknown numbers that change, with their ranges and what they may be."""
    _, columns = find_numbers(others)
    moving = {name: v for name, v in columns.items() if np.nanmin(v) < np.nanmax(v)}
    if not moving:
        return ""
    ranges = [f"{n} ({np.nanmin(v):.4g} to {np.nanmax(v):.4g})" for n, v in moving.items()]
    suggestion = hint(moving)
    return _some(ranges) + (f". {suggestion}" if suggestion else "")
