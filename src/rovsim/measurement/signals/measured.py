"""What of a motion was measured, where it was not all of it."""

from dataclasses import dataclass, replace
from typing import Iterator, Mapping

import numpy as np
from numpy import ndarray as Array

SHARE = 0.25  # of the rate of the slowest channel: half of its Nyquist frequency
HIGHEST = 0.4  # of the sampling rate: a low-pass that cuts off nearer to its half hardly filters
NAMES = ("coordinates", "heading", "axes", "summed", "when", "cutoff")


@dataclass(frozen=True, eq=False)
class Measured:
    """What was measured of a run of n samples; what was not is zero in its poses and velocities.

    `coordinates` (3,) of the position NED; `heading` (1,) whether yaw; `axes` (6,) surge to yaw, in
    which motion shows; `summed` (6,) those summed up from velocities; `when` (n, 6) samples at
    which a reading came; `cutoff` (1,) Hz above which the slowest channel shows nothing.
    """

    coordinates: Array
    heading: Array
    axes: Array
    summed: Array
    when: Array
    cutoff: Array

    @property
    def period(self) -> float:
        """Time between two samples of the slowest channel, s."""
        return SHARE / float(self.cutoff[0])

    def part(self, at: slice) -> "Measured":
        """Of some samples of the run."""
        return replace(self, when=self.when[at])

    def by_name(self) -> Iterator[tuple[str, Array]]:
        """Arrays under the names that `from_names` knows."""
        for name in NAMES:
            yield f"measured.{name}", getattr(self, name)

    @staticmethod
    def from_names(arrays: Mapping[str, Array]) -> "Measured | None":
        """Undo `by_name`; None where everything was measured."""
        if f"measured.{NAMES[0]}" not in arrays:
            return None
        return Measured(*(arrays[f"measured.{name}"] for name in NAMES))


def find_measured(measured: Measured | None) -> Array:
    """Which axes (6,) were measured."""
    return np.ones(6, bool) if measured is None else measured.axes


def blank(measured: Measured | None, x: Array, value: float) -> Array:
    """Velocities or accelerations (..., 6) with `value` where nothing was measured."""
    return x if measured is None else np.where(measured.axes, x, value)
