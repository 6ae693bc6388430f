"""When a message was measured: its own stamp where that can be believed, else when it arrived."""

from typing import Any

import numpy as np
from numpy import ndarray as Array

from rovsim.core.signs import minus

NANO = 1e-9
# Transport within one computer or network takes less; another clock is off by more.
SAME_CLOCK = 0.5  # s
# Stamps of one clock differ from the arrivals by a delay that varies by less than this.
STEADY = 0.5  # s, between the 5th and the 95th percentile


def on_bag_clock(topic: str, arrived: Array, stamps: Array) -> tuple[Array, tuple[str, ...]]:
    """Times (n,) in s on the clock of the bag, of arrivals and stamps (n,) in ns.

    Stamps hold as they are where their clock is that of the bag. Those of another computer are
    shifted by the median of their difference, so the usual delay of transport counts as none.
    Returns what had to be done as well.
    """
    bag = arrived * NANO
    if not stamps.all():
        said = () if not stamps.any() else (f"{topic}: stamps are missing; the bag's times hold.",)
        return bag, said
    late = (arrived - stamps) * NANO
    low, middle, high = np.percentile(late, [5.0, 50.0, 95.0])
    if high - low > STEADY or (len(stamps) > 1 and not stamps[-1] > stamps[0]):
        return bag, (f"{topic}: stamps do not go with the bag's clock; the bag's times hold.",)
    if abs(middle) <= SAME_CLOCK:
        return stamps * NANO, ()
    shifted = (stamps - stamps[0]) * NANO + (stamps[0] * NANO + middle)
    off = minus(f"{-middle:+.3f}")
    note = f"{topic}: its stamps are {off} s from the bag's clock and were shifted to it."
    return shifted, (note,)


def stamp(message: Any) -> int:
    """Stamp in ns; 0 where there is none."""
    header = getattr(message, "header", None)
    given = getattr(header, "stamp", None)
    return 0 if given is None else given.sec * 1_000_000_000 + given.nanosec
