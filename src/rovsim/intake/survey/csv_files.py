"""Find motions and commands in csv files."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Mapping, NamedTuple

import numpy as np
from numpy import ndarray as Array

from rovsim.core import pwm
from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.pwm import PILOT
from rovsim.intake.survey.command_names import (
    find_range,
    find_wrench,
    has_other_unit,
    hint,
)
from rovsim.intake.survey.contents import CommandCandidate, Contents, LoggedKind, Track
from rovsim.intake.survey.headings import rewritten
from rovsim.intake.survey.other_numbers import TimedColumns, find_numbers, find_sparse, read_others
from rovsim.intake.survey.repeats import check_unmixed, tell_repeats
from rovsim.intake.survey.sizes import Key, Unit, Units
from rovsim.measurement.campaign_file import Mocap
from rovsim.measurement.recording.commands import ALLOWED, PERCENT, are_pulses, guess_unit
from rovsim.measurement.recording.formats.csv import KNOWN, read_csv
from rovsim.measurement.recording.one_run import check_one_run
from rovsim.measurement.recording.tables.delimited import Lines, csv_lines
from rovsim.measurement.recording.tables.named_columns import TIME, no_time
from rovsim.measurement.recording.tidying import tidy_export

RADIO = re.compile(r"(?:rc|rcin_?c?|chan)_?(\d+)(?:_raw)?", re.IGNORECASE)
THOUSANDTHS = 1050.0  # how far shares of a full stick reach that were multiplied by 1000
NEAR_HALF = 0.1  # of commands whose medians lie so near to it
HALF = "numbers within 0 and 1 about 0.5; if 0.5 is at rest, write 2 x - 1 and normalized"
EXPECTED = "pulses of 800 to 2200 us, shares from -1 to 1, or columns named after axes"


class UnknownColumns(BadInput):
    """Columns of numbers that are neither a measured channel nor commands of a known kind."""


def look_into_csv(path: Path, scratch: Path, known: Mapping[Key, Unit] | None = None) -> Contents:
    """Find out what a csv file holds.

    Args:
        path: of the file.
        scratch: folder for a copy under our names of columns, where the file has others.
        known: units that other files tell for columns of the same names.

    Raises:
        BadInput: the file holds neither a measured channel nor what looks like commands.
    """
    units = Units(known or {})
    place, notes = rewritten(path, scratch, units)
    try:
        return replace(_look(path, place, notes), units=units.found)
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
    channels = [name for name in lines.names if name in KNOWN]
    other_columns = read_others(lines)
    drive = _drive(lines, other_columns)
    if drive is not None:
        check_one_run(drive.time[np.isfinite(drive.value).any(axis=1)], path)
    unknown = "" if drive else _unknown(other_columns)
    if not channels and drive is None:
        raise _nothing(path, lines, unknown)
    tracks = (_track(place),) if channels else ()
    drives = () if drive is None else (drive,)
    original = None if place == path else path
    unread = tuple(name for name in lines.names if name and name not in (*KNOWN, TIME))
    doubts = tell_repeats(lines, [*channels, *(drive.bare if drive else ())])
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
    if TIME not in lines.names:
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
        expected=EXPECTED,
        remedy="Convert them, name the columns after measurements with their units, or leave the "
        "file out.",
    )


def _some(names: list[str]) -> str:
    return ", ".join(names[:12]) + (" …" if len(names) > 12 else "")


def _track(path: Path) -> Track:
    mocap = Mocap(format="csv", world_axes="ned", body_axes="frd")
    return Track("", tidy_export(read_csv(path, mocap), path))


def _unknown(others: TimedColumns) -> str:
    """List columns of unknown numbers that change, with their ranges and what they may be."""
    _, columns = find_numbers(others)
    moving = {name: v for name, v in columns.items() if np.nanmin(v) < np.nanmax(v)}
    if not moving:
        return ""
    ranges = [f"{n} ({np.nanmin(v):.4g} to {np.nanmax(v):.4g})" for n, v in moving.items()]
    suggestion = hint(moving)
    return _some(ranges) + (f". {suggestion}" if suggestion else "")


def _drive(lines: Lines, others: TimedColumns) -> CommandCandidate | None:
    """Return the columns that look like commands, if there are any."""
    voltage = ("voltage",) if lines.names.count("voltage") == 1 else ()
    candidate = _commands(*find_numbers(others), voltage)
    if candidate is None:
        candidate = _commands(*find_sparse(others), ())
        return candidate if candidate and candidate.kind else None
    return candidate


def _commands(
    time: Array, columns: dict[str, Array], voltage: tuple[str, ...]
) -> CommandCandidate | None:
    """Find commands among columns of numbers: radio channels, forces, pulses or shares.

    Args:
        time: (m,) s.
        columns: (m,) each, by name.
        voltage: name of a column of battery voltage, if there is one.
    """
    if radio := _radio(columns):
        value = np.stack([columns[name] for name in radio.values()], axis=1)
        signed = tuple("-" * (c[0] == "-") + name for c, name in radio.items())
        reason = "the pilot's radio by ArduSub's order of channels"
        return CommandCandidate(
            "csv",
            signed,
            time,
            value,
            "demand",
            reason,
            axes=tuple(PILOT[c] for c in radio),
            auxiliary=voltage,
        )
    kind, names, reason = _likely_commands(columns)
    forces = find_wrench(columns) if kind not in ("pwm", "demand") else {}
    if forces:
        value = np.stack([columns[name] for name in forces.values()], axis=1)
        reason = "guess: forces and moments by their names, N and N m: x forward, y right, z down"
        return CommandCandidate(
            "csv",
            tuple(forces.values()),
            time,
            value,
            "wrench",
            reason,
            axes=tuple(forces),
            auxiliary=voltage,
            asked=within(value.ravel(), "demand"),
        )
    if not names:
        return None
    value = np.stack([columns[name] for name in names], axis=1)
    value = pwm.of_outputs(value)[0] if kind == "pwm" else value
    rest = {name: column for name, column in columns.items() if name not in names}
    return CommandCandidate(
        "csv",
        tuple(names),
        time,
        value,
        kind,
        reason,
        auxiliary=voltage,
        rest=rest,
        asked=kind == "wrench" or reason == HALF,
    )


def _radio(columns: dict[str, Array]) -> dict[str, str]:
    """Find columns of a pilot's radio, such as RC1 or chan1_raw, by ArduSub's channels."""
    numbered = {
        f"RC{int(match[1])}": name
        for name, value in columns.items()
        if (match := RADIO.fullmatch(name)) and within(value, "pwm")
    }
    return {c: numbered[c.lstrip("-")] for c in PILOT if c.lstrip("-") in numbered}


class _LikelyCommands(NamedTuple):
    """Columns that are likely commands.

    Attributes:
        kind: of the commands; None where the numbers do not tell it.
        columns: their names; none where there are no commands.
        said: how both are known, for a person to read.
    """

    kind: LoggedKind | None
    columns: list[str]
    said: str


def _likely_commands(columns: dict[str, Array]) -> _LikelyCommands:
    """Find the columns that are likely commands, and their kind, by their names and numbers."""
    axes = [name for name in columns if name in AXES]
    if len(axes) > 1 or (axes and len(columns) == 1):
        if all(within(columns[name], "demand") for name in axes):
            return _LikelyCommands("demand", axes, "named after axes, within -1 and 1")
        if all(within(columns[name], "pwm") for name in axes):
            reason = "named after axes, pulses in us (-heave where long is up)"
            return _LikelyCommands("demand", axes, reason)
        return _LikelyCommands("wrench", axes, _wrench([columns[name] for name in axes]))
    plain = {name: value for name, value in columns.items() if not has_other_unit(name)}
    pulses = [name for name in plain if within(columns[name], "pwm")]
    if pulses:
        values = [value[~pwm.absent(value)] for value in map(columns.__getitem__, pulses)]
        low, high = find_range(values)
        reason = f"all from {low:.0f} to {high:.0f}: pulses in us"
        return _LikelyCommands("pwm", ordered(pulses), reason)
    shares = [name for name in plain if within(columns[name], "normalized")]
    if shares and len(shares) == len(columns):
        if _rests_at_half([columns[name] for name in shares]):
            return _LikelyCommands("normalized", ordered(shares), HALF)
        return _LikelyCommands("normalized", ordered(shares), "all within -1 and 1")
    numbered = [name for name in columns if re.search(r"\d$", name)]
    reason = _sizes([columns[name] for name in numbered])
    return _LikelyCommands(None, ordered(numbered), reason)


def _rests_at_half(values: list[Array]) -> bool:
    """Whether shares lie within 0 and 1, about the middle: then 0.5 may be at rest."""
    low, high = find_range(values)
    usual = float(np.median([np.nanmedian(value) for value in values]))
    return low >= 0.0 and high <= 1.0 and low < 0.5 < high and abs(usual - 0.5) < NEAR_HALF


def within(value: Array, kind: LoggedKind) -> bool:
    """Whether a column can be commands of a kind, by the size of its numbers."""
    if kind == "pwm":
        return are_pulses(value)
    low, high = ALLOWED[kind][:2]
    finite = value[np.isfinite(value)]
    return bool(len(finite) and finite.min() >= low and finite.max() <= high)


def ordered(names: list[str]) -> list[str]:
    """Sort names by the numbers they end in, if they differ in nothing else."""
    parts = [re.fullmatch(r"(.*?)(\d+)", name) for name in names]
    if not all(parts) or len({part[1] for part in parts if part}) > 1:
        return names
    return sorted(names, key=lambda name: int(re.sub(r".*?(\d+)$", r"\1", name)))


def _wrench(values: list[Array]) -> str:
    """Say what columns named after axes may be: their size does not tell forces from percent."""
    low, high = find_range(values)
    remark = f"named after axes, beyond -1 and 1 ({low:.4g} to {high:.4g})"
    if max(-low, high) <= PERCENT:
        return f"{remark}. If these are percent, divide them by 100 and write demand"
    if max(-low, high) <= THOUSANDTHS:
        return f"{remark}. If these are thousandths, divide them by 1000 and write demand"
    return remark


def _sizes(values: list[Array]) -> str:
    if not values:
        return ""
    low, high = find_range(values)
    unit = guess_unit(low, high)
    return f"numbers from {low:.4g} to {high:.4g}" + (f", perhaps {unit}" if unit else "")
