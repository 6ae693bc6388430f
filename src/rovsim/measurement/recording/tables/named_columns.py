"""Find columns by their names, with an error that helps where one (often the time) is missing."""

import re
from pathlib import Path
from typing import Sequence

from rovsim.core.errors import BadInput, nearest
from rovsim.measurement.recording.tables.cells import is_number
from rovsim.measurement.recording.tables.dates import resembles_date

TIME_COLUMN = "time_s"
# What people, loggers and pandas call a column of times; one without a name may be such.
TIME_NAMES = re.compile(
    r"|unnamed.*|index|t|t[\W_]+.*|.*time.*|.*stamp.*|secs?|seconds|utc.*|clock.*|elapsed.*|date.*",
    re.IGNORECASE,
)
FRAME_NAMES = {"frame", "frames", "frame_no", "frame_number", "frame number"}


def column_places(path: Path, names: list[str], wanted: list[str]) -> list[int]:
    """Find the indices of the wanted columns among `names`.

    Raises:
        BadInput: one is missing, or named twice.
    """
    for name in wanted:
        if names.count(name) > 1:
            raise BadInput(
                f"two columns are named '{name}'",
                where=path,
                expected="every column named once",
                remedy="Rename or remove one of them.",
            )
        if name not in names and name == TIME_COLUMN:
            raise no_time(path, names)
        if name not in names:
            unused = [n for n in names if n not in wanted]
            raise BadInput(
                f"no column '{name}', but {', '.join(names)}",
                where=path,
                expected=f"the columns {', '.join(wanted)}",
                remedy=nearest(name, unused) if unused else "Export again with that column.",
            )
    return [names.index(name) for name in wanted]


def no_time(path: Path, names: list[str]) -> BadInput:
    """Make the error for a file without a column of times, with a guess which column it may be."""
    if all(is_number(name) or resembles_date(name) for name in names):
        return BadInput(
            f"no line of column names above the values {', '.join(names[:4])}, …",
            where=path,
            expected=f"names in the first line, among them {TIME_COLUMN}",
            remedy="Put one above them: time_s,x_m,y_m,z_m,qw,qx,qy,qz or time_s,t1,t2,… for what "
            "the columns hold (docs/formats.md).",
        )
    quoted = [
        f"'{name}'" if name else f"one without a name (the {k + 1}.)"
        for k, name in enumerate(names)
    ]
    likely = [q for q, name in zip(quoted, names, strict=True) if TIME_NAMES.fullmatch(name)]
    return BadInput(
        f"no column '{TIME_COLUMN}', but {', '.join(quoted)}",
        where=f"{path}, column names",
        expected=f"a column {TIME_COLUMN}: seconds, dates or times of day (ISO 8601)",
        remedy=_how_to_name_times(names, likely),
    )


def _how_to_name_times(names: Sequence[str], likely: Sequence[str]) -> str:
    if halves := find_halves(names):
        return f"Write one column {TIME_COLUMN} = {halves[0]} + 1e-9 * {halves[1]}."
    if likely:
        return f"Did you mean {' or '.join(likely)}? If it holds the times, name it {TIME_COLUMN}."
    if any(name.lower() in FRAME_NAMES for name in names):
        return f"Write a column {TIME_COLUMN}: the frame divided by the rate of the cameras in Hz."
    return f"Give the column of the times the name {TIME_COLUMN}."


def find_halves(names: Sequence[str]) -> tuple[str, str] | None:
    """Find a column of whole seconds and one of nanoseconds, into which stamps of ROS are split."""
    for name in names:
        if match := re.fullmatch(r"(.*?)n(ano)?sec(ond)?s?", name, re.IGNORECASE):
            pattern = re.compile(re.escape(match[1]) + r"sec(ond)?s?", re.IGNORECASE)
            if seconds := next((n for n in names if pattern.fullmatch(n)), None):
                return seconds, name
    return None
