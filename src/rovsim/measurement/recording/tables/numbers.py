"""Read the numbers of columns, with errors that name the line and the column."""

import re

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.tables.cells import MISSING_WORDS
from rovsim.measurement.recording.tables.delimited import Lines

LINES_PER_BATCH = 10_000  # lines: if one of them needs the slow way, all of these are read in it


def numbers(table: Lines, columns: list[int]) -> Array:
    """Read the numbers (n, c) of c columns; an empty cell is NaN.

    Raises:
        BadInput: a cell is missing or holds no number.
    """
    values = np.empty((len(table), len(columns)))
    for start in range(0, len(table), LINES_PER_BATCH):
        part = table.between(start, start + LINES_PER_BATCH)
        values[start : start + LINES_PER_BATCH] = _plain_numbers(part, columns)
    return values


def _plain_numbers(table: Lines, columns: list[int]) -> Array:
    try:
        return np.loadtxt(
            table.rows, comments=None, delimiter=table.separator, usecols=columns, ndmin=2
        )
    except ValueError:  # empty cells, or cells that the slow way refuses with their place
        rows = zip(table.all_cells(), table.numbers, strict=True)
        return np.array([[_number(table, row, n, c) for c in columns] for row, n in rows])


def _number(table: Lines, row: list[str], line: int, column: int) -> float:
    if column >= len(row):
        raise BadInput(
            f"the line has {len(row)} cells and stops before '{table.names[column]}'",
            where=f"{table.path}, line {line}",
            expected=f"{len(table.names)} cells",
            remedy="Export the run again, or remove that line.",
        )
    cell = row[column].strip()
    if cell.lower() in MISSING_WORDS:
        return float("nan")
    try:
        return float(cell)
    except ValueError:
        raise bad_cell(table, line, column, cell, "a number") from None


def bad_cell(table: Lines, line: int, column: int, cell: str, expected: str) -> BadInput:
    """Make the error for a cell that does not hold what is expected."""
    place = f"{table.path}, line {line}, column '{table.names[column]}'"
    if re.match(r"\d{4}-\d\d-\d\d|\d\d?:\d\d:|\d\d?-[A-Za-z]{3}-\d{2,4}", cell):
        return BadInput(
            f"{cell!r} is a date or a time of day",
            where=place,
            expected=expected,
            remedy="Only times may be such, all of a file alike, as 2026-05-12T10:00:12.5 or "
            "10:00:12.5; else write seconds.",
        )
    if re.fullmatch(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?", cell):
        return BadInput(
            f"{cell!r} is written with a decimal comma",
            where=place,
            expected="a decimal point",
            remedy="Export again with decimal points.",
        )
    return BadInput(
        f"the cell holds {cell!r}" if cell else "the cell is empty",
        where=place,
        expected=expected,
        remedy="Correct or remove that line.",
    )
