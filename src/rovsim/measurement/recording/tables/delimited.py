"""Delimited text: find the line of column names, the separator, and the lines of data."""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Iterator, Sequence

from rovsim.core.errors import BadInput
from rovsim.core.files import read_text
from rovsim.measurement.recording.signature import decoded
from rovsim.measurement.recording.tables.cells import is_number
from rovsim.measurement.recording.tables.dates import is_date
from rovsim.measurement.recording.tables.units import with_units


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines of data below a line of column names.

    Lines are split into cells only on demand: cells take ten times the memory of their text.

    Attributes:
        path: the file.
        names: the column names.
        separator: what separates cells.
        rows: the lines.
        numbers: their line numbers in the file, from 1.
        ended: False when the file stops in the middle of a line (no line end after it).
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
        """Cells of one line, by its index in `rows` (negative from the end)."""
        return self.rows[row].split(self.separator)

    def all_cells(self) -> Iterator[list[str]]:
        """Cells of each line."""
        return (row.split(self.separator) for row in self.rows)

    def between(self, first: int, last: int) -> "Lines":
        """The lines of indices `first` to `last` - 1."""
        rows, numbers = self.rows[first:last], self.numbers[first:last]
        return replace(self, rows=rows, numbers=numbers, ended=True)


def csv_lines(path: Path) -> Lines:
    """Read the lines of a csv file below its line of column names.

    Cells are separated by commas; or by semicolons or tabs, and then commas in numbers are decimal
    points; or else by blanks. Comment lines (#), quotes, a line of units and repetitions of the
    line of names are not data.

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
    # files that were put end to end repeat the line of names
    rows = [line if line != lines[header] else "" for line in lines]
    if separator != ",":
        rows = [line.replace(",", ".") for line in rows]
    names, below = with_units(names, rows, header, separator)
    return split_lines(path, rows, below, names, separator, ended=text.endswith("\n"))


def find_separator(head: str, below: str) -> str:
    """Find what separates the cells of a line of names and of the line below it."""
    separators = [s for s in ",;\t" if head.count(s)]
    # the comma comes last: names may have as many ("x, m") as the numbers have decimal commas
    matches = [s for s in reversed(separators) if head.count(s) == below.count(s)]
    if separators:
        return (matches or separators)[0]
    return " " if len(head.split()) == len(below.split()) > 1 else ","


def is_table(head: bytes) -> bool:
    """Whether text begins with a line of names above a line of numbers, separated by blanks."""
    lines = (decoded(head) or "").split("\n")
    header = find_header(lines)
    if header is None:
        return False
    names, *rows = [line.lstrip("# ").split() for line in lines[header:] if line.strip()]
    numeric = [all(map(is_number, row)) for row in rows[:1]]
    return numeric == [True] and len(names) == len(rows[0]) > 1 and not any(map(is_number, names))


def _is_quoted(head: str) -> bool:
    """Whether every name is in quotes; then every cell may be."""
    return bool(re.fullmatch(r'[#\s]*"[^"]*"(\s*[,;\t]\s*"[^"]*")+\s*', head))


def find_header(lines: Sequence[str]) -> int | None:
    """Find the index of the line of column names: the first that is not a comment (#).

    Where numbers follow the comments at once, the last comment holds the names.

    Returns:
        The index from 0; None for a file without text.
    """
    filled = [n for n, line in enumerate(lines) if line.strip()]
    header = next((n for n in filled if not lines[n].lstrip().startswith("#")), None)
    comments = [n for n in filled if header is None or n < header]
    begins = "" if header is None else re.split(r"[,;\t]", lines[header])[0]
    if header is None or (comments and (is_number(begins.split(" ")[0]) or is_date(begins))):
        return comments[-1] if comments else header
    return header


def split_lines(
    path: Path, lines: list[str], header: int, names: list[str], separator: str, *, ended: bool
) -> Lines:
    """Make `Lines` of the lines below line `header` (index from 0); blank ones are skipped."""
    filled = [n for n in range(header + 1, len(lines)) if lines[n].strip()]
    rows = [lines[n] for n in filled]
    return Lines(path, names, separator, rows, [n + 1 for n in filled], ended)


def without_cut_line(table: Lines, columns: list[int]) -> tuple[Lines, int]:
    """Drop the last line if it was cut off; return how many lines were dropped (0 or 1).

    It was cut off if it ends before one of the `columns` in use, or in the middle of such a cell.
    """
    if not len(table):
        return table, 0
    cells = table.cells(-1)
    short = len(cells) <= max(columns)
    ragged = not table.ended and len(cells) - 1 in columns and not is_number(cells[-1])
    if not (short or ragged):
        return table, 0
    return table.between(0, len(table) - 1), 1
