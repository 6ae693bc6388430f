"""Find several runs or bodies in one file, and times that repeat as they are too coarse."""

from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.formats.csv import KNOWN_COLUMNS, POSITION
from rovsim.measurement.recording.one_run import SeveralRuns, find_begins
from rovsim.measurement.recording.tables.delimited import Lines, without_cut_line
from rovsim.measurement.recording.tables.named_columns import TIME_COLUMN
from rovsim.measurement.recording.tables.numbers import numbers
from rovsim.measurement.recording.tables.times import times

MIN_REPEATED_SHARE = 0.1  # of the lines whose time another has
MAX_LABELS = 20  # runs or bodies in one file
HEAD_LINES = 1000  # that tell whether a column may hold labels
MIN_CHANGE_SHARE = 0.25  # of the lines are of another body than the line before
MIN_JUMP_RATIO = 10.0  # times as far as a body moves from one of its lines to its next


def check_unmixed(lines: Lines) -> None:
    """Refuse a file of several runs or bodies that a column of labels tells apart.

    Times begin anew where the label of a run changes; positions jump where that of a body changes.

    Raises:
        SeveralRuns: it holds several runs, or several bodies.
    """
    time = _times(lines)
    begins = find_begins(time)
    for name, labels in _labels(lines, len(time)):
        changes = np.flatnonzero(labels[1:] != labels[:-1]) + 1
        if len(begins) > 1 and set(begins[1:]) <= set(changes) and len(changes) < 2 * len(begins):
            raise _several(lines, "runs", "its times begin anew where", name, labels[begins])
        if len(changes) > MIN_CHANGE_SHARE * len(labels) and _jumps(lines, labels):
            bodies = [label for label in dict.fromkeys(labels) if label]
            raise _several(lines, "bodies", "it jumps from one to another where", name, bodies)


def _labels(lines: Lines, count: int) -> Iterator[tuple[str, Array]]:
    """List columns of at most `MAX_LABELS` different words or numbers that are no measurement.

    Yields:
        The name of a column, and its first `count` cells.
    """
    places = [k for k, name in enumerate(lines.names) if name not in (*KNOWN_COLUMNS, TIME_COLUMN)]
    head = _cells(lines, min(count, HEAD_LINES), places)
    candidates = [
        k for k, column in zip(places, head, strict=True) if len(set(column)) <= MAX_LABELS
    ]
    for place, column in zip(candidates, _cells(lines, count, candidates), strict=True):
        if 1 < len(set(column)) <= MAX_LABELS:
            yield lines.names[place], np.array(column)


def _cells(lines: Lines, count: int, places: Sequence[int]) -> list[list[str]]:
    """Return the first `count` cells of each of the columns at `places`."""
    columns: list[list[str]] = [[] for _ in places]
    for row in range(count if places else 0):
        cells = lines.cells(row)
        for place, column in zip(places, columns, strict=True):
            column.append(cells[place].strip(' "') if place < len(cells) else "")
    return columns


def _jumps(lines: Lines, labels: Array) -> bool:
    """Whether positions jump where labels (n,) change, compared to the steps within a label."""
    places = [lines.names.index(name) for name in POSITION if name in lines.names]
    if not places:
        return False
    try:
        value = numbers(without_cut_line(lines, places)[0], places)[: len(labels)]
    except BadInput:
        return False
    labels = labels[: len(value)]
    between = np.linalg.norm(np.diff(value, axis=0), axis=1)[labels[1:] != labels[:-1]]
    steps = [np.linalg.norm(np.diff(value[labels == k], axis=0), axis=1) for k in set(labels)]
    within = np.concatenate(steps)
    if not (np.isfinite(between).any() and np.isfinite(within).any()):
        return False
    return float(np.nanmedian(between)) > MIN_JUMP_RATIO * float(np.nanmedian(within))


def _several(
    lines: Lines, what: str, how: str, name: str, labels: Sequence[str] | Array
) -> SeveralRuns:
    examples = ", ".join(labels[:6]) + (" …" if len(labels) > 6 else "")
    return SeveralRuns(
        f"{len(labels)} {what} in one file: {how} '{name}' changes ({examples})",
        where=lines.path,
        expected="one run and one body a file",
        remedy=f"Split it by '{name}', a file for each, and a log of commands by its runs.",
    )


def warn_of_repeats(lines: Lines, columns: Sequence[str]) -> tuple[str, ...]:
    """Warn where many lines that hold a value of one of these columns share their times."""
    places = [lines.names.index(name) for name in columns]
    time = _times(lines, places)
    if _double(time) < MIN_REPEATED_SHARE * len(time) or not columns:
        return ()
    value = numbers(without_cut_line(lines, [lines.names.index(TIME_COLUMN), *places])[0], places)
    repeats = max(_double(time[np.isfinite(column)]) for column in value.T)
    if repeats < MIN_REPEATED_SHARE * len(time):
        return ()
    coarse = ". They are whole seconds: export them with decimals"
    advice = coarse if np.array_equal(time, np.round(time)) else ""
    return (f"{repeats} of {len(time)} lines have the time of another and are not used{advice}",)


def _double(time: Array) -> int:
    """Count the times that repeat an earlier one."""
    return len(time) - len(np.unique(time))


def _times(lines: Lines, others: Sequence[int] = ()) -> Array:
    """Return times (n,) s of the lines, without a last line that is cut off before a column.

    Args:
        lines: of the file.
        others: positions of columns that a line has to reach beside the times.
    """
    if TIME_COLUMN not in lines.names:
        return np.empty(0)
    place = lines.names.index(TIME_COLUMN)
    return times(without_cut_line(lines, [place, *others])[0], place)
