"""Copy csv files whose columns have other names or units than ours (`time_s, x_m, …`).

The reader of the format csv takes columns by name and unit, so a file with other names is read as a
copy, and the user is told what was renamed and converted.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.files import write_text
from rovsim.intake.survey.column_names import find_columns
from rovsim.intake.survey.command_names import STICKS, are_sticks, find_wrench
from rovsim.intake.survey.quaternions import check_quaternion
from rovsim.intake.survey.sizes import Unit, Units, find_by_size
from rovsim.intake.survey.time_units import find_time_unit
from rovsim.measurement.recording.csv_checks import is_height
from rovsim.measurement.recording.formats.csv import ANGULAR, EULER, LINEAR, POSITION, QUATERNION
from rovsim.measurement.recording.tables.cells import find_filler
from rovsim.measurement.recording.tables.delimited import Lines, csv_lines, without_cut_line
from rovsim.measurement.recording.tables.named_columns import find_halves, no_time
from rovsim.measurement.recording.tables.numbers import numbers
from rovsim.measurement.recording.tables.times import dates, times
from rovsim.measurement.recording.tables.units import DEGREE, SI_FACTORS, split_unit

HALF_TURN = 180.0  # degrees


@dataclass(frozen=True)
class ChannelColumn:
    """A column of the file that is one of our channels.

    Attributes:
        ours: our name of the channel.
        place: position of the column in the file.
        factor: from the file's unit to ours.
        note: the unit and how it is known, to append to a sentence; may be empty.
    """

    ours: str
    place: int
    factor: float
    note: str


def rewritten(path: Path, scratch: Path, units: Units) -> tuple[Path, tuple[str, ...]]:
    """Copy a csv file under our names and in our units, if it has others.

    Args:
        path: of the file.
        scratch: folder for the copy.
        units: that other files tell; units that are found by size are added to it.

    Returns:
        The file to read (itself or the copy), and sentences on what was changed.

    Raises:
        BadInput: not a csv file, or its units cannot be told.
    """
    lines = csv_lines(path)
    check_quaternion(lines)
    columns = _columns(lines, units)
    changed = [c for c in columns if c.factor != 1.0 or lines.names[c.place] != c.ours]
    if not changed or not any(c.ours == "time_s" for c in columns):
        return path, ()
    copy = scratch / f"{path.stem}.csv"
    write_text(copy, _text(lines, {c.place: c for c in columns}))
    changes = [f"'{lines.names[c.place]}' is {_without_unit(c.ours)}{c.note}" for c in changed]
    return copy, (f"{path.name} is read as a copy with other columns: {'; '.join(changes)}",)


def _without_unit(ours: str) -> str:
    """Remove our unit from a name of ours, to tell the file's own unit instead."""
    return re.sub(r"_(s|m|rad)(_s2?)?$", "", ours)


def _text(lines: Lines, columns: dict[int, ChannelColumn]) -> str:
    names = [columns[k].ours if k in columns else name for k, name in enumerate(lines.names)]
    rows = [",".join(names)]
    fillers = {k: find_filler(_raw(lines, k)) for k in columns}
    for cells in lines.all_cells():
        row = (_cell(c, columns.get(k), fillers.get(k)) for k, c in enumerate(cells))
        rows.append(",".join(row))
    return "\n".join(rows) + "\n"


def _cell(text: str, column: ChannelColumn | None, filler: float | None) -> str:
    text = text.strip()
    if column is None or not text:
        return text
    try:
        value = float(text)
    except ValueError:
        return text
    if value == filler:
        return ""
    if column.ours in EULER[:2] and column.factor == DEGREE and abs(value) > HALF_TURN:
        value = (value + HALF_TURN) % (2.0 * HALF_TURN) - HALF_TURN  # 359 degrees for -1
    return text if column.factor == 1.0 else repr(value * column.factor)


def _columns(lines: Lines, units: Units) -> list[ChannelColumn]:
    """Find the columns that are our channels, under any name or unit; none without times."""
    unit_at = [split_unit(name)[1] for name in lines.names]
    places = find_columns(lines)
    _drop_ambiguous(places, lines)
    if lines.names[places.get("time_s", 0)] in (find_halves(lines.names) or ()):
        raise no_time(lines.path, lines.names)
    if "time_s" not in places:
        return []
    place = places["time_s"]
    dated = dates(lines, place)
    if dated is not None:
        times(without_cut_line(lines, [place])[0], place)  # refuses what is no date among them
    seconds, factor, reason = dated, 1.0, " from dates"
    if seconds is None:
        value = _values(lines, place)
        factor, reason = find_time_unit(lines, place, value, unit_at[place], units)
        seconds = value * factor
    columns = [ChannelColumn("time_s", place, factor, reason)]
    for group in (POSITION, EULER, QUATERNION, LINEAR, ANGULAR, ["depth_m"]):
        present = {ours: places[ours] for ours in group if ours in places}
        columns += _group(lines, present, {k: unit_at[k] for k in present.values()}, seconds, units)
    return columns


def _drop_ambiguous(places: dict[str, int], lines: Lines) -> None:
    """Drop channels with ambiguous names: 'roll' may be a demand, and 'p' and 'u' anything.

    They are kept where other channels of their group speak for them.

    Args:
        places: positions of columns by our names; changed in place.
        lines: of the file.
    """
    renamed = {ours for ours, place in places.items() if lines.names[place] != ours}
    has_quaternion = all(name in places for name in QUATERNION)
    demanded = bool({"surge", "sway", "heave"} & set(lines.names)) or "x_m" not in places
    dropped = set() if has_quaternion else set(QUATERNION)
    bare = {n for n in EULER if n in renamed and lines.names[places[n]].lower() in AXES}
    dropped |= renamed & set(EULER) if has_quaternion else bare if demanded else set()
    for group in (LINEAR, ANGULAR):
        dropped |= set() if all(name in places for name in group) else renamed & set(group)
    pushing = {lines.names[places[n]] for n in renamed & set(POSITION)}
    if pushing & set(find_wrench(lines.names).values()) or (
        set(POSITION) <= renamed and _of_a_stick(lines, places)
    ):
        dropped |= set(POSITION)
    for name in dropped & set(places):
        del places[name]


def _of_a_stick(lines: Lines, places: dict[str, int]) -> bool:
    """Whether x, y, z are a pilot's stick: beside a column r, and no attitude in the file."""
    has_attitude = any(name in places for name in (*EULER, *QUATERNION))
    sticks = {n: k for k, n in enumerate(lines.names) if n.lower() in STICKS}
    if has_attitude or len(sticks) < len(STICKS):
        return False
    return are_sticks({name: _values(lines, place) for name, place in sticks.items()})


def _values(lines: Lines, place: int) -> Array:
    """Return a column (n,) of numbers, NaN where the file has a filler for missing values."""
    value = _raw(lines, place)
    filler = find_filler(value)
    return value if filler is None else np.where(value == filler, np.nan, value)


def _raw(lines: Lines, place: int) -> Array:
    """Return a column (n,) of numbers, all NaN where it holds words."""
    table, cut_lines = without_cut_line(lines, [place])
    try:
        return np.concatenate([numbers(table, [place])[:, 0], np.full(cut_lines, np.nan)])
    except BadInput:
        return np.full(len(lines), np.nan)


def _group(
    lines: Lines, here: dict[str, int], units: dict[int, str], time: Array, shared_units: Units
) -> list[ChannelColumn]:
    """Make the columns of one group of channels; a unit that is not named is found by size.

    Args:
        lines: of the file.
        here: positions of these columns, by our names.
        units: that names state, by position; empty where a name states none.
        time: (n,) s.
        shared_units: units that other files tell.
    """
    if not here:
        return []
    names, columns = list(here), list(here.values())
    # refuses words already here, where the message names the user's own file
    numbers(without_cut_line(lines, columns)[0], columns)
    value = np.stack([_values(lines, place) for place in here.values()], axis=1)
    if names[0] in QUATERNION:
        return [ChannelColumn(n, p, 1.0, "") for n, p in here.items()]
    if names[0] == "depth_m":
        return [_depth(lines, here, units, value[:, 0], shared_units)]
    factor, reason = find_by_size(lines, here, value, time, shared_units)
    return [
        ChannelColumn(
            n,
            p,
            SI_FACTORS[units[p]] if units[p] and not reason else factor,
            reason or _of(units[p]),
        )
        for n, p in here.items()
    ]


def _depth(
    lines: Lines, here: dict[str, int], units: dict[int, str], value: Array, shared_units: Units
) -> ChannelColumn:
    """Make the column of a depth; its sign is turned where it is a height, here or elsewhere."""
    ((ours, place),) = here.items()

    def decide() -> Unit:
        if is_height(value):
            return Unit(-1.0, " with its sign turned, for it is negative", True)
        return Unit(1.0, "", is_height(-value))

    sign = shared_units.settle((lines.names[place],), decide)
    factor = sign.factor * SI_FACTORS.get(units[place], 1.0)
    return ChannelColumn(ours, place, factor, f"{_of(units[place])}{sign.note}")


def _of(unit: str) -> str:
    return f" in {unit}" if unit else ""
