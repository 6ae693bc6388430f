"""Refuse files whose times start again: two recordings, one after the other in a file."""

from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput

MIN_STEP_BACK_S = 1.0  # lines that are merely out of order step back less
MIN_SAMPLES, MIN_SHARE = 10, 0.05  # of the smallest part that counts; of all
MIN_OVERLAP_SHARE = 0.5  # of the shorter part: a clock that was merely set back repeats less of it


class SeveralRuns(BadInput):
    """A file that holds several runs, or several bodies line by line."""


def find_begins(time: Array) -> Array:
    """Indices (k,) of the samples at which times (n,) s start again; the first is 0."""
    return np.concatenate([[0], np.flatnonzero(np.diff(time) < -MIN_STEP_BACK_S) + 1])


def check_one_run(time: Array, path: Path) -> None:
    """Refuse times (n,) s, in the order of the file, that start again and overlap with the first.

    Sorted by time, two such runs would alternate from sample to sample.

    Raises:
        SeveralRuns: the file holds several runs.
    """
    begins = find_begins(time)
    parts = np.split(time, begins[1:])
    if len(parts) < 2 or min(map(len, parts)) < max(MIN_SAMPLES, MIN_SHARE * len(time)):
        return
    for before, after in pairwise(parts):
        low, high = max(before.min(), after.min()), min(before.max(), after.max())
        if high - low > MIN_OVERLAP_SHARE * min(np.ptp(before), np.ptp(after)):
            break
    else:
        return
    sizes = " and ".join(f"{len(part)} samples" for part in parts)
    raise SeveralRuns(
        f"{len(parts)} runs in one file: its times begin anew ({sizes})",
        where=path,
        expected="one run a file",
        remedy="Split it where the times step back, a file for each run, and a log of commands "
        "likewise.",
    )
