"""Csv files whose columns have other names or units: a copy that says the same as `time_s, x_m, …`.

The format csv takes columns by name and unit, so other names need a copy; what was done is told.
"""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.errors import BadInput
from rovsim.core.files import write_text
from rovsim.measurement.recording.csv import ANGULAR, EULER, LINEAR, POSITION, QUATERNION
from rovsim.measurement.recording.csv_checks import LONGEST_STEP, is_height
from rovsim.measurement.recording.table import (
    Lines,
    csv_lines,
    find_filler,
    numbers,
    without_cut_line,
)
from rovsim.measurement.recording.times import LATEST, dates, times
from rovsim.measurement.survey.column_names import FORMS, UNITS, split_unit
from rovsim.measurement.survey.command_names import STICKS, are_sticks
from rovsim.measurement.survey.quaternions import check_quaternion
from rovsim.measurement.survey.sizes import Units, find_by_size

SHORTEST_STEP = 2e-4  # s between two lines of any recording


@dataclass(frozen=True)
class Column:
    """A column of ours: its place in the file, the factor to our unit, and how it is known."""

    ours: str
    place: int
    factor: float
    said: str


def rewritten(path: Path, scratch: Path, units: Units) -> tuple[Path, tuple[str, ...]]:
    """The file to read: itself, or a copy in `scratch` with our names and units, and what changed.

    `units`: those that other files tell; it keeps those that are found by size.

    Raises:
        BadInput: not a csv file, or its units cannot be told.
    """
    lines = csv_lines(path)
    check_quaternion(lines)
    found = _columns(lines, units)
    changed = [c for c in found if c.factor != 1.0 or lines.names[c.place] != c.ours]
    if not changed or not any(c.ours == "time_s" for c in found):
        return path, ()
    copy = scratch / f"{path.stem}.csv"
    write_text(copy, _text(lines, {c.place: c for c in found}))
    told = [f"'{lines.names[c.place]}' is {_without_unit(c.ours)}{c.said}" for c in changed]
    return copy, (f"{path.name} is read as a copy with other columns: {'; '.join(told)}",)


def _without_unit(ours: str) -> str:
    """The name of a column without our unit, where the file's own is told."""
    return re.sub(r"_(s|m|rad)(_s2?)?$", "", ours)


def _text(lines: Lines, columns: dict[int, Column]) -> str:
    names = [columns[k].ours if k in columns else name for k, name in enumerate(lines.names)]
    rows = [",".join(names)]
    fillers = {k: find_filler(_raw(lines, k)) for k in columns}
    for cells in lines.all_cells():
        told = (_cell(c, columns.get(k), fillers.get(k)) for k, c in enumerate(cells))
        rows.append(",".join(told))
    return "\n".join(rows) + "\n"


def _cell(text: str, column: Column | None, filler: float | None) -> str:
    text = text.strip()
    if column is None or not text:
        return text
    try:
        value = float(text)
    except ValueError:
        return text
    if value == filler:
        return ""
    return text if column.factor == 1.0 else repr(value * column.factor)


def _columns(lines: Lines, units: Units) -> list[Column]:
    """Columns that are ours under another name or unit."""
    plain = {k: split_unit(name) for k, name in enumerate(lines.names)}
    places = {
        ours: k
        for ours, form in FORMS.items()
        for k, (stem, _) in plain.items()
        if lines.names[k] == ours or (ours not in lines.names and re.fullmatch(form, stem))
    }
    _drop_ambiguous(places, lines)
    if "time_s" not in places:
        return []
    place = places["time_s"]
    dated = dates(lines, place)
    if dated is not None:
        times(without_cut_line(lines, [place])[0], place)  # refuses what is no date among them
    time, said = _time(lines, place, plain[place][1]) if dated is None else (1.0, " from dates")
    columns = [Column("time_s", place, time, said)]
    seconds = _values(lines, place) * time if dated is None else dated
    for group in (POSITION, EULER, QUATERNION, LINEAR, ANGULAR, ["depth_m"]):
        here = {ours: places[ours] for ours in group if ours in places}
        columns += _group(lines, here, {k: plain[k][1] for k in here.values()}, seconds, units)
    return columns


def _drop_ambiguous(places: dict[str, int], lines: Lines) -> None:
    """Bare letters are channels only in company: 'roll' may be a demand, 'p' and 'u' anything."""
    renamed = {ours for ours, place in places.items() if lines.names[place] != ours}
    whole = all(name in places for name in QUATERNION)
    demanded = bool({"surge", "sway", "heave"} & set(lines.names)) or "x_m" not in places
    dropped = set() if whole else set(QUATERNION)
    bare = {n for n in EULER if n in renamed and lines.names[places[n]].lower() in AXES}
    dropped |= renamed & set(EULER) if whole else bare if demanded else set()
    for group in (LINEAR, ANGULAR):
        dropped |= set() if all(name in places for name in group) else renamed & set(group)
    if set(POSITION) <= renamed and _of_a_stick(lines, places):
        dropped |= set(POSITION)
    for name in dropped & set(places):
        del places[name]


def _of_a_stick(lines: Lines, places: dict[str, int]) -> bool:
    """Whether x, y, z are those of a stick, beside an r and no angle."""
    turned = any(name in places for name in (*EULER, *QUATERNION))
    named = {n: k for k, n in enumerate(lines.names) if n.lower() in STICKS}
    if turned or len(named) < len(STICKS):
        return False
    return are_sticks({name: _values(lines, place) for name, place in named.items()})


def _values(lines: Lines, place: int) -> Array:
    value = _raw(lines, place)
    filler = find_filler(value)
    return value if filler is None else np.where(value == filler, np.nan, value)


def _raw(lines: Lines, place: int) -> Array:
    whole, cut = without_cut_line(lines, [place])
    try:
        return np.concatenate([numbers(whole, [place])[:, 0], np.full(cut, np.nan)])
    except BadInput:
        return np.full(len(lines), np.nan)


def _time(lines: Lines, place: int, unit: str) -> tuple[float, str]:
    """Factor to seconds of the times, and how it is known."""
    value = _values(lines, place)
    if not np.isfinite(value).any():
        times(lines, place)  # says what they are
    step = float(np.nanmedian(np.abs(np.diff(value)))) if len(value) > 1 else 1.0
    named = lines.names[place] == "time_s"
    if named and step < LONGEST_STEP and not np.nanmax(np.abs(value), initial=0.0) > LATEST:
        return 1.0, ""
    if unit and not named:
        return UNITS[unit], f" in {unit}"
    late = float(np.nanmax(np.abs(value), initial=0.0))
    for name, size in (("ns", 1e17), ("us", 1e14), ("ms", 1e11)):
        if late > size:
            return UNITS[name], f" in {name} since 1970, by its size"
    if SHORTEST_STEP <= step < LONGEST_STEP or not step > 0.0:
        return 1.0, " in s, by its steps"
    name = "ms" if step < 1e3 * LONGEST_STEP else "us" if step < 1e6 * LONGEST_STEP else "ns"
    return UNITS[name], f" in {name}, by its steps"


def _group(
    lines: Lines, here: dict[str, int], units: dict[int, str], time: Array, told: Units
) -> list[Column]:
    """Columns of one kind; those without a unit in their name get one by their size."""
    if not here:
        return []
    names, columns = list(here), list(here.values())
    numbers(without_cut_line(lines, columns)[0], columns)  # refuses words, in the owner's own file
    value = np.stack([_values(lines, place) for place in here.values()], axis=1)
    if names[0] in QUATERNION:
        return [Column(n, p, 1.0, "") for n, p in here.items()]
    if names[0] == "depth_m" and is_height(value[:, 0]):
        return _turned(lines, here, units)
    factor, said = find_by_size(lines, here, value, time, told)
    return [
        Column(n, p, UNITS[units[p]] if units[p] and not said else factor, said or _of(units[p]))
        for n, p in here.items()
    ]


def _turned(lines: Lines, here: dict[str, int], units: dict[int, str]) -> list[Column]:
    """A height for a depth: its sign is turned."""
    ((ours, place),) = here.items()
    factor, unit = UNITS.get(units[place], 1.0), units[place]
    return [Column(ours, place, -factor, f"{_of(unit)} with its sign turned, for it is negative")]


def _of(unit: str) -> str:
    return f" in {unit}" if unit else ""
