"""Times that repeat: several runs in one file, or stamps that are too coarse."""

from itertools import pairwise
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.measurement.recording.csv import KNOWN
from rovsim.measurement.recording.table import TIME, Lines, numbers, without_cut_line
from rovsim.measurement.recording.times import times

BACK = 1.0  # s: lines that are merely out of order step back less
MANY = 0.1  # share of the lines whose time another has


class SeveralRuns(BadInput):
    """A file that holds several runs, one after the other."""


def check_one_run(lines: Lines) -> None:
    """Refuse a file whose times begin anew wherever another column changes.

    Raises:
        SeveralRuns: it is one.
    """
    time = _times(lines)
    begins = [0, *(np.flatnonzero(np.diff(time) < -BACK) + 1)]
    if len(begins) < 2:
        return
    cells = [lines.cells(row) for row in range(len(time))]
    for place, name in enumerate(lines.names):
        if name in (*KNOWN, TIME):
            continue
        values = [row[place].strip() if place < len(row) else "" for row in cells]
        changes = [k + 1 for k, (a, b) in enumerate(pairwise(values)) if a != b]
        if set(begins[1:]) <= set(changes) and len(changes) < 2 * len(begins):
            raise _several(lines, name, [values[k] for k in begins])


def _several(lines: Lines, name: str, values: Sequence[str]) -> SeveralRuns:
    told = ", ".join(values[:6]) + (" …" if len(values) > 6 else "")
    return SeveralRuns(
        f"{len(values)} runs in one file: its times begin anew where '{name}' changes ({told})",
        where=lines.path,
        expected="one run a file",
        remedy=f"Split it by '{name}', a file for each run, and a log of commands likewise.",
    )


def tell_repeats(lines: Lines, columns: Sequence[str]) -> tuple[str, ...]:
    """A sentence where many lines that hold one of these columns share their times; else none."""
    places = [lines.names.index(name) for name in columns]
    time = _times(lines, places)
    if _double(time) < MANY * len(time) or not columns:
        return ()
    value = numbers(without_cut_line(lines, [lines.names.index(TIME), *places])[0], places)
    double = max(_double(time[np.isfinite(column)]) for column in value.T)
    if double < MANY * len(time):
        return ()
    coarse = ". They are whole seconds: export them with decimals"
    more = coarse if np.array_equal(time, np.round(time)) else ""
    return (f"{double} of {len(time)} lines have the time of another and are not used{more}",)


def _double(time: Array) -> int:
    return len(time) - len(np.unique(time))


def _times(lines: Lines, others: Sequence[int] = ()) -> Array:
    """Times (n,) s of the lines that hold the other columns as well; none without a column."""
    if TIME not in lines.names:
        return np.empty(0)
    place = lines.names.index(TIME)
    return times(without_cut_line(lines, [place, *others])[0], place)
