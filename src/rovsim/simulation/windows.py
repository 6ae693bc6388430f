"""Where replays start anew: windows of some seconds inside usable stretches."""

from typing import Iterable, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.signals.motion import Motion

LAST_SHARE = 0.75  # of a window's length, that what is left of an uneven run must last


def find_windows(motion: Motion, seconds: float) -> Iterator[tuple[int, int]]:
    """Index pairs (anchor, end) of full windows inside usable stretches.

    None where a window is shorter than half a sample.

    Of bins, whose number follows the uneven clock, the next window starts at the one that begins
    nearest to `seconds` later.
    """
    for first, last in motion.segments():
        if motion.binned:
            yield from _find_bins(motion, first, last, seconds)
            continue
        count = round(seconds / time_step(motion.time))
        for anchor in range(first, last - count, count) if count else ():
            yield anchor, anchor + count


def _find_bins(motion: Motion, first: int, last: int, seconds: float) -> Iterator[tuple[int, int]]:
    starts = np.append(motion.time, motion.end)[: last + 1]
    anchor = first
    while starts[last] - starts[anchor] >= LAST_SHARE * seconds:
        end = anchor + 1 + int(np.argmin(np.abs(starts[anchor + 1 :] - starts[anchor] - seconds)))
        yield anchor, end
        if end >= last:
            return
        anchor = end


def predicted(motion: Motion, window: tuple[int, int]) -> slice:
    """Samples or bins that a window predicts: not the sample that it begins with."""
    anchor, end = window
    return slice(anchor, end) if motion.binned else slice(anchor + 1, end + 1)


def last_predicted(motion: Motion, windows: Iterable[tuple[int, int]]) -> Array:
    """The last of them (w,) in each window."""
    return np.array([predicted(motion, window).stop - 1 for window in windows], int)


def find_whole(motion: Motion) -> list[tuple[int, int]]:
    """From the first usable sample to the last sample, once; nothing of an unusable run."""
    last = len(motion.time) - (0 if motion.binned else 1)
    return [(first, last) for first, _ in motion.segments()[:1] if first < last]
