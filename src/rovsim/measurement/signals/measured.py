"""Which components of a motion were measured, for runs without full poses."""

from dataclasses import dataclass, replace
from typing import Iterator, Mapping

import numpy as np
from numpy import ndarray as Array

CUTOFF_SHARE = 0.25  # of the rate of the slowest channel: half of its Nyquist frequency
MAX_CUTOFF_SHARE = 0.4  # of the sampling rate: nearer to its half, a low-pass hardly filters
ARRAY_NAMES = ("coordinates", "heading", "axes", "summed", "when", "cutoff")


@dataclass(frozen=True, eq=False)
class Measured:
    """Which components of a run of n samples were measured; the others are zero in its poses.

    Attributes:
        coordinates: bool (3,), which of x, y and z NED are known, directly or by integration.
        heading: bool (1,), whether the yaw angle is known.
        axes: bool (6,), the axes surge to yaw in which the motion is known.
        summed: bool (6,), which of x, y, z, roll, pitch and yaw are integrals of measured
            velocities or rates.
        when: bool (n, 6), for each axis the samples at which its main channel was read.
        cutoff: (1,) Hz, the frequency above which the slowest channel shows nothing.
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
        return CUTOFF_SHARE / float(self.cutoff[0])

    def part(self, at: slice) -> "Measured":
        """What was measured in a slice of the samples."""
        return replace(self, when=self.when[at])

    def by_name(self) -> Iterator[tuple[str, Array]]:
        """Yield the arrays with the names under which `from_names` finds them."""
        for name in ARRAY_NAMES:
            yield f"measured.{name}", getattr(self, name)

    @staticmethod
    def from_names(arrays: Mapping[str, Array]) -> "Measured | None":
        """Put together what `by_name` named; None where everything was measured."""
        if f"measured.{ARRAY_NAMES[0]}" not in arrays:
            return None
        return Measured(*(arrays[f"measured.{name}"] for name in ARRAY_NAMES))


def find_measured(measured: Measured | None) -> Array:
    """Which axes, bool (6,) from surge to yaw, were measured; all of them for None."""
    return np.ones(6, bool) if measured is None else measured.axes


def blank(measured: Measured | None, x: Array, value: float) -> Array:
    """Velocities or accelerations (..., 6) with `value` in the axes that were not measured."""
    return x if measured is None else np.where(measured.axes, x, value)
