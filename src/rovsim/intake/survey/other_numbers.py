"""Read columns of a csv file that hold numbers and are no measured channel: perhaps commands.

Commands may stand on every line, or on lines of their own where several topics share a file.
"""

import re
from collections import defaultdict

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.measurement.recording.formats.csv import KNOWN_COLUMNS
from rovsim.measurement.recording.tables.delimited import Lines, without_cut_line
from rovsim.measurement.recording.tables.named_columns import TIME_COLUMN, column_places
from rovsim.measurement.recording.tables.numbers import numbers
from rovsim.measurement.recording.tables.times import times

# Columns that count or monitor something, whatever the size of their numbers.
MONITORED_NAMES = re.compile(
    r"(frame|index|idx|count|seq|id|line|row|unnamed.*|volt.*|battery.*|bat|current.*|amp.*|temp.*|"
    r"pressure.*|mode|armed|status|quality|residual|sec|nsec|stamp|time.*|)(_.*)?",
    re.IGNORECASE,
)
MIN_FILLED_SHARE = 0.5  # of the lines in which a column of commands has a value
MIN_LINES = 10  # of a series on lines of its own
TimedColumns = tuple[Array, dict[str, Array]]  # times (m,) s, and columns (m,) by their names


def read_others(lines: Lines) -> TimedColumns:
    """Read columns of numbers, neither channels nor `MONITORED_NAMES`; none without times."""
    if TIME_COLUMN not in lines.names:
        return np.empty(0), {}
    names = [
        name
        for name in lines.names
        if name not in (*KNOWN_COLUMNS, TIME_COLUMN)
        and lines.names.count(name) == 1
        and not MONITORED_NAMES.fullmatch(name)
    ]
    places = column_places(lines.path, lines.names, [TIME_COLUMN, *names])
    table, _ = without_cut_line(lines, places)
    columns = {
        n: v
        for n, p in zip(names, places[1:], strict=True)
        if (v := _numbers(table, p)) is not None
    }
    return times(table, places[0]), columns


def find_numbers(others: TimedColumns) -> TimedColumns:
    """Select the columns that have a value on at least half of the lines."""
    time, columns = others
    return time, {n: v for n, v in columns.items() if np.isfinite(v).mean() >= MIN_FILLED_SHARE}


def find_sparse(others: TimedColumns) -> TimedColumns:
    """Select the longest series of columns that have values on the same few lines.

    A series is columns whose names differ in a number, or that are named after axes. Only the lines
    on which they have values are returned.
    """
    time, columns = others
    series: dict[tuple[str, bytes], list[str]] = defaultdict(list)
    for name, value in columns.items():
        present = np.isfinite(value)
        if MIN_LINES <= present.sum() < MIN_FILLED_SHARE * len(value):
            series[_stem(name), present.tobytes()].append(name)
    longest = max(series.values(), key=len, default=[])
    if len(longest) < 2:
        return time[:0], {}
    present = np.isfinite(columns[longest[0]])
    return time[present], {name: columns[name][present] for name in longest}


def _stem(name: str) -> str:
    """Return what the names of a series share, such as `t#` for t1; empty for names of axes."""
    return "" if name in AXES else re.sub(r"\d+(?=\D*$)", "#", name)


def _numbers(table: Lines, place: int) -> Array | None:
    """Return a column (n,) of numbers; None where it holds words or is empty."""
    try:
        value = numbers(table, [place])[:, 0]
    except BadInput:
        return None
    return value if np.isfinite(value).any() else None
