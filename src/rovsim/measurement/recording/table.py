"""Columns of numbers in delimited text, with the line and column of whatever is wrong."""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, nearest
from rovsim.core.files import read_text
from rovsim.measurement.recording.dates import is_date
from rovsim.measurement.recording.signature import decoded
from rovsim.measurement.recording.units import with_units

MISSING = {"", "na", "n/a", "#n/a", "null", "none", "-"}  # words for "not measured", in any case
# What loggers write where a sensor gave nothing; believed where no other value comes near.
FILLERS = (-999.0, -9999.0, -99999.0, 9999.0, 99999.0)
NEAR = 0.5  # of a filler: a column that reaches so far may mean it
TIME = "time_s"
# What people, loggers and pandas call a column of times; one without a name may be such.
LIKE_TIME = re.compile(
    r"|unnamed.*|index|t|t[\W_]+.*|.*time.*|.*stamp.*|secs?|seconds|utc.*|clock.*|elapsed.*|date.*",
    re.IGNORECASE,
)
FRAMES = {"frame", "frames", "frame_no", "frame_number", "frame number"}
AT_ONCE = 10_000  # lines: where one of them needs a closer look, so many get it


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines below a line of column names, their cells `separator` apart.

    `numbers` are the line numbers in the file, from 1; `ended` is False when the file stops in
    the middle of a line (no line end after it). Lines are split when they are asked for: cells
    take ten times the room of their text.
    """

    path: Path
    names: list[str]
    separator: str
    rows: Sequence[str]
    numbers: Sequence[int]
    ended: bool = True

    def __len__(self) -> int:
        return len(self.rows)

    def cells(self, row: int) -> list[str]:
        """Cells of one line, counted from the first below the names, or from the last."""
        return self.rows[row].split(self.separator)

    def all_cells(self) -> Iterator[list[str]]:
        """Cells of each line."""
        return (row.split(self.separator) for row in self.rows)

    def between(self, first: int, last: int) -> "Lines":
        """Lines from the first up to the one before the last."""
        rows, numbers = self.rows[first:last], self.numbers[first:last]
        return replace(self, rows=rows, numbers=numbers, ended=True)


def csv_lines(path: Path) -> Lines:
    """Lines of a csv file below its line of column names.

    Commas separate, or semicolons or tabs, and then a comma in a number is a decimal point; else
    blanks. Remarks (#), quotes, a line of units and further lines of the same names are no data.

    Raises:
        BadInput: the file is empty.
    """
    text = read_text(path)
    lines = text.split("\n")
    header = find_header(lines)
    if header is None:
        raise BadInput(
            "the file is empty",
            where=path,
            expected="a line of column names and lines of numbers",
            remedy="Export the run again.",
        )
    lines = [line.replace('"', "") for line in lines] if _is_quoted(lines[header]) else lines
    head = lines[header].lstrip("# ")
    separator = find_separator(head, next((x for x in lines[header + 1 :] if x.strip()), ""))
    if separator == " ":
        lines, separator = [",".join(line.lstrip("# ").split()) for line in lines], ","
        head = lines[header]
    names = [cell.strip().strip('"') for cell in head.rstrip(f" {separator}").split(separator)]
    rows = [line if line != lines[header] else "" for line in lines]  # of files put end to end
    if separator != ",":
        rows = [line.replace(",", ".") for line in rows]
    names, below = with_units(names, rows, header, separator)
    return split_lines(path, rows, below, names, separator, ended=text.endswith("\n"))


def find_separator(head: str, below: str) -> str:
    """What separates the cells of a line of names and of the line below it."""
    fitting = [s for s in ",;\t" if head.count(s)]
    # last the comma: names may have as many ("x, m") as the numbers below have decimal ones
    alike = [s for s in reversed(fitting) if head.count(s) == below.count(s)]
    if fitting:
        return (alike or fitting)[0]
    return " " if len(head.split()) == len(below.split()) > 1 else ","


def is_table(head: bytes) -> bool:
    """Whether text begins with a line of names, and numbers below it, with blanks between them."""
    lines = (decoded(head) or "").split("\n")
    header = find_header(lines)
    if header is None:
        return False
    names, *rows = [line.lstrip("# ").split() for line in lines[header:] if line.strip()]
    numeric = [all(map(_is_number, row)) for row in rows[:1]]
    return numeric == [True] and len(names) == len(rows[0]) > 1 and not any(map(_is_number, names))


def _is_quoted(head: str) -> bool:
    """Whether every name stands in quotes, and so every cell may."""
    return bool(re.fullmatch(r'[#\s]*"[^"]*"(\s*[,;\t]\s*"[^"]*")+\s*', head))


def find_header(lines: Sequence[str]) -> int | None:
    """Which line holds the names of columns: the first that is no remark.

    Remarks start with #; where numbers follow at once, the last of them holds the names.
    """
    filled = [n for n, line in enumerate(lines) if line.strip()]
    first = next((n for n in filled if not lines[n].lstrip().startswith("#")), None)
    before = [n for n in filled if first is None or n < first]
    begins = "" if first is None else re.split(r"[,;\t]", lines[first])[0]
    if first is None or (before and (_is_number(begins.split(" ")[0]) or is_date(begins))):
        return before[-1] if before else first
    return first


def split_lines(
    path: Path, lines: list[str], header: int, names: list[str], separator: str, *, ended: bool
) -> Lines:
    """Split the lines below line `header` (index from 0); blank ones are skipped."""
    filled = [n for n in range(header + 1, len(lines)) if lines[n].strip()]
    rows = [lines[n] for n in filled]
    return Lines(path, names, separator, rows, [n + 1 for n in filled], ended)


def without_cut_line(table: Lines, columns: list[int]) -> tuple[Lines, int]:
    """Drop a last line that was cut; return how many were dropped (0, 1).

    It is cut when it stops before one of the `columns` in use, or in the middle of such a cell.
    """
    if not len(table):
        return table, 0
    last = table.cells(-1)
    short = len(last) <= max(columns)
    ragged = not table.ended and len(last) - 1 in columns and not _is_number(last[-1])
    if not (short or ragged):
        return table, 0
    return table.between(0, len(table) - 1), 1


def column_places(path: Path, names: list[str], wanted: list[str]) -> list[int]:
    """Places of the wanted columns among `names`.

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
        if name not in names and name == TIME:
            raise no_time(path, names)
        if name not in names:
            others = [other for other in names if other not in wanted]
            raise BadInput(
                f"no column '{name}', but {', '.join(names)}",
                where=path,
                expected=f"the columns {', '.join(wanted)}",
                remedy=nearest(name, others) if others else "Export again with that column.",
            )
    return [names.index(name) for name in wanted]


def no_time(path: Path, names: list[str]) -> BadInput:
    """The error of a file without a column of times: which one may be it, by its name."""
    if all(_is_number(name) for name in names):
        return BadInput(
            f"no line of column names above the numbers {', '.join(names[:4])}, …",
            where=path,
            expected=f"names in the first line, among them {TIME}",
            remedy="Put one above them: time_s,x_m,y_m,z_m,qw,qx,qy,qz or time_s,t1,t2,… for what "
            "the columns hold (docs/formats.md).",
        )
    told = [
        f"'{name}'" if name else f"one without a name (the {k + 1}.)"
        for k, name in enumerate(names)
    ]
    likely = [one for one, name in zip(told, names, strict=True) if LIKE_TIME.fullmatch(name)]
    return BadInput(
        f"no column '{TIME}', but {', '.join(told)}",
        where=f"{path}, column names",
        expected=f"a column {TIME}: seconds, dates or times of day (ISO 8601)",
        remedy=_how_to_name_times(names, likely),
    )


def _how_to_name_times(names: Sequence[str], likely: Sequence[str]) -> str:
    if halves := find_halves(names):
        return f"Write one column {TIME} = {halves[0]} + 1e-9 * {halves[1]}."
    if likely:
        return f"Did you mean {' or '.join(likely)}? If it holds the times, name it {TIME}."
    if any(name.lower() in FRAMES for name in names):
        return f"Write a column {TIME}: the frame divided by the rate of the cameras in Hz."
    return f"Give the column of the times the name {TIME}."


def find_halves(names: Sequence[str]) -> tuple[str, str] | None:
    """Columns of whole seconds and of the nanoseconds beyond them, as stamps of ROS come apart."""
    for name in names:
        if found := re.fullmatch(r"(.*?)n(ano)?sec(ond)?s?", name, re.IGNORECASE):
            whole = re.compile(re.escape(found[1]) + r"sec(ond)?s?", re.IGNORECASE)
            if other := next((n for n in names if whole.fullmatch(n)), None):
                return other, name
    return None


def numbers(table: Lines, columns: list[int]) -> Array:
    """Numbers (lines, columns) of those columns; an empty cell is NaN.

    Raises:
        BadInput: a cell is missing or holds no number.
    """
    found = np.empty((len(table), len(columns)))
    for first in range(0, len(table), AT_ONCE):
        some = table.between(first, first + AT_ONCE)
        found[first : first + AT_ONCE] = _plain_numbers(some, columns)
    return found


def _plain_numbers(table: Lines, columns: list[int]) -> Array:
    try:
        return np.loadtxt(
            table.rows, comments=None, delimiter=table.separator, usecols=columns, ndmin=2
        )
    except ValueError:  # empty cells, or what a message will be about
        rows = zip(table.all_cells(), table.numbers, strict=True)
        return np.array([[_number(table, row, n, c) for c in columns] for row, n in rows])


def find_filler(values: Array) -> float | None:
    """The value of a column (n,) that stands for "not measured"; None without one."""
    for filler in FILLERS:
        here = values == filler
        others = np.abs(values[~here & np.isfinite(values)])
        if here.sum() > 1 and len(others) and others.max() < NEAR * abs(filler):
            return filler
    return None


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return cell.strip().lower() in MISSING
    return True


def _number(table: Lines, row: list[str], line: int, column: int) -> float:
    if column >= len(row):
        raise BadInput(
            f"the line has {len(row)} cells and stops before '{table.names[column]}'",
            where=f"{table.path}, line {line}",
            expected=f"{len(table.names)} cells",
            remedy="Export the run again, or remove that line.",
        )
    cell = row[column].strip()
    if cell.lower() in MISSING:
        return float("nan")
    try:
        return float(cell)
    except ValueError:
        raise bad_cell(table, line, column, cell, "a number") from None


def bad_cell(table: Lines, line: int, column: int, cell: str, expected: str) -> BadInput:
    """The error of a cell that holds something else than expected."""
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
