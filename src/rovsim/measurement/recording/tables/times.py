"""A column of times in a table: seconds, dates or times of day."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.tables.dates import is_date, resembles_date, to_seconds
from rovsim.measurement.recording.tables.delimited import Lines
from rovsim.measurement.recording.tables.numbers import bad_cell, numbers

MAX_TIME_S = 1e11  # since 1970: the year 5138


def times(table: Lines, column: int) -> Array:
    """Read the times (n,) s of one column, which may be dates or times of day.

    Raises:
        BadInput: a time is no finite number.
    """
    dated = dates(table, column)
    if dated is None:
        _refuse_date(table, 0, column)
    time = numbers(table, [column])[:, 0] if dated is None else dated
    invalid = np.flatnonzero(~np.isfinite(time))
    if invalid.size:
        _refuse_date(table, int(invalid[0]), column)
        cell = table.cells(int(invalid[0]))[column].strip()
        raise bad_cell(
            table, table.numbers[invalid[0]], column, cell, "a time in s, or all as dates"
        )
    if len(time) and np.abs(time).max() > MAX_TIME_S:
        raise BadInput(
            f"times up to {np.abs(time).max():.3g}: ms, us or ns since 1970?",
            where=f"{table.path}, column '{table.names[column]}'",
            expected="seconds",
            remedy="Name the column after its unit (time_ms, time_us, time_ns), and let "
            "`rovsim init` make a copy in s.",
        )
    return time


def _refuse_date(table: Lines, row: int, column: int) -> None:
    """Refuse a cell with a date or time of day that is not written by ISO 8601.

    Raises:
        BadInput: the cell holds one.
    """
    cells = table.cells(row) if len(table) else []
    cell = cells[column].strip(' "') if column < len(cells) else ""
    if not resembles_date(cell):
        return
    raise BadInput(
        f"{cell!r} is a date or a time of day that is not written by ISO 8601",
        where=f"{table.path}, line {table.numbers[row]}, column '{table.names[column]}'",
        expected="all times in s, or all as 2026-05-12T10:00:12.5, or as 10:00:12.5 (24 hours, "
        "two digits each)",
        remedy="Convert the column: in a spreadsheet with the format yyyy-mm-dd hh:mm:ss.000, in "
        "pandas with pd.to_datetime(…).dt.strftime('%Y-%m-%dT%H:%M:%S.%f').",
    )


def dates(table: Lines, column: int) -> Array | None:
    """Read times (n,) s of a column that begins with a date or time of day; None if it does not."""
    cells = (row[column].strip(' "') if column < len(row) else "" for row in table.all_cells())
    first_cell = next(cells, "")
    return to_seconds([first_cell, *cells]) if is_date(first_cell) else None
