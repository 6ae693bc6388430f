"""Times of messages: their own stamps where these can be trusted, else the times of arrival."""

from typing import Any

import numpy as np
from numpy import ndarray as Array

from rovsim.core.signs import minus

NANO = 1e-9
# Transport within one computer or network takes less; clocks of two computers differ by more.
MAX_CLOCK_OFFSET_S = 0.5
# Stamps of one clock differ from the arrivals by a delay that varies by less than this.
MAX_DELAY_SPREAD_S = 0.5  # between the 5th and the 95th percentile


def on_bag_clock(topic: str, arrived: Array, stamps: Array) -> tuple[Array, tuple[str, ...]]:
    """Find the times of messages on the clock of the bag.

    Stamps are used as they are where their clock is that of the bag. Those of another computer are
    shifted by the median difference from the arrivals, so the usual transport delay counts as zero.

    Args:
        topic: its name, for the notes.
        arrived: times of arrival (n,), ns.
        stamps: time stamps (n,) in the messages, ns; 0 where there is none.

    Returns:
        Times (n,) s, and sentences about what was done.
    """
    bag = arrived * NANO
    if not stamps.all():
        notes = () if not stamps.any() else (f"{topic}: stamps are missing; the bag's times hold.",)
        return bag, notes
    delay = (arrived - stamps) * NANO
    low, median, high = np.percentile(delay, [5.0, 50.0, 95.0])
    if high - low > MAX_DELAY_SPREAD_S or (len(stamps) > 1 and not stamps[-1] > stamps[0]):
        return bag, (f"{topic}: stamps do not go with the bag's clock; the bag's times hold.",)
    if abs(median) <= MAX_CLOCK_OFFSET_S:
        return stamps * NANO, ()
    shifted = (stamps - stamps[0]) * NANO + (stamps[0] * NANO + median)
    offset = minus(f"{-median:+.3f}")
    note = f"{topic}: its stamps are {offset} s from the bag's clock and were shifted to it."
    return shifted, (note,)


def stamp(message: Any) -> int:
    """Time stamp in the header of a message, ns; 0 where there is none."""
    header = getattr(message, "header", None)
    time = getattr(header, "stamp", None)
    return 0 if time is None else time.sec * 1_000_000_000 + time.nanosec
