"""Windows of some seconds inside usable stretches: a replay starts again in each of them."""

from typing import Iterable, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.motion import Motion

MIN_LAST_SHARE = 0.75  # of a window's length, that what is left of an uneven run must last


def find_windows(motion: Motion, seconds: float) -> Iterator[tuple[int, int]]:
    """Find all full windows inside usable stretches, each beginning where the last one ended.

    A window of a binned run ends at the bin that begins nearest to `seconds` after its start, since
    bins may differ in length.

    Args:
        motion: the run.
        seconds: length of a window; of windows shorter than half a sampling period none are found.

    Yields:
        Sample or bin at which each window begins, and the one at which it ends.
    """
    for first, last in motion.segments():
        if motion.binned:
            yield from _find_bins(motion, first, last, seconds)
            continue
        count = round(seconds / time_step(motion.time))
        for anchor in range(first, last - count, count) if count else ():
            yield anchor, anchor + count


def _find_bins(motion: Motion, first: int, last: int, seconds: float) -> Iterator[tuple[int, int]]:
    """Find the windows among the bins `first` to `last` - 1 of a binned run."""
    starts = np.append(motion.time, motion.end)[: last + 1]
    anchor = first
    while starts[last] - starts[anchor] >= MIN_LAST_SHARE * seconds:
        end = anchor + 1 + int(np.argmin(np.abs(starts[anchor + 1 :] - starts[anchor] - seconds)))
        yield anchor, end
        if end >= last:
            return
        anchor = end


def predicted(motion: Motion, window: tuple[int, int]) -> slice:
    """Samples or bins of a window that are predicted; the sample that it begins with is given."""
    anchor, end = window
    return slice(anchor, end) if motion.binned else slice(anchor + 1, end + 1)


def last_predicted(motion: Motion, windows: Iterable[tuple[int, int]]) -> Array:
    """The last sample or bin (w,) that is predicted in each window."""
    return np.array([predicted(motion, window).stop - 1 for window in windows], int)


def find_whole(motion: Motion) -> list[tuple[int, int]]:
    """One window from the first usable sample to the last sample; none for an unusable run."""
    last = len(motion.time) - (0 if motion.binned else 1)
    return [(first, last) for first, _ in motion.segments()[:1] if first < last]
