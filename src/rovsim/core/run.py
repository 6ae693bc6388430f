"""A run's identity, its commands, and where it was recorded; used by all other packages."""

from dataclasses import dataclass, field, replace
from typing import Literal, Mapping

import numpy as np
from numpy import ndarray as Array

CommandKind = Literal["thruster", "demand", "wrench"]
Between = Literal["held", "linear"]  # how commands go on between two logged lines


def latest(time: Array, at: Array | float) -> Array:
    """Index of the latest line at or before each instant; the first line for earlier instants.

    Args:
        time: times (m,) of the lines, s, increasing.
        at: instants, s, of any shape. Add a tolerance where they are computed in another way than
            `time`, because a line holds from its own instant on.
    """
    return np.asarray(np.maximum(np.searchsorted(time, at, side="right") - 1, 0))


@dataclass(frozen=True)
class RunInfo:
    """Which run this is: its `id`, `control` (3dof | 6dof) and `split` (train | test)."""

    id: str
    control: str
    split: str


@dataclass(frozen=True, eq=False)
class Logged:
    """A number that was logged beside the commands: `value` (m,) at `time` (m,) s, increasing."""

    time: Array
    value: Array


@dataclass(frozen=True, eq=False)
class Commands:
    """The commands of a run, in m logged lines, each of which holds until the next one.

    Without lines (m = 0) nothing was commanded: free decay, towing, drifting.

    Attributes:
        time: (m,) s, on the MoCap clock, increasing.
        value: (m, c). Commands of the thrusters in [-1, 1] and angles in rad, in the columns of
            `Vehicle.command_columns` (kind `thruster`); demands for each axis in [-1, 1]
            (`demand`); or a body wrench in N, N m (`wrench`).
        kind: what the values are.
        auxiliary: further logged numbers, by name; `voltage` is that of the battery, V.
        before: time of the recording that lies before this part of it, s.
        after: time of the recording that lies after this part of it, s.
    """

    time: Array
    value: Array
    kind: CommandKind
    auxiliary: Mapping[str, Logged] = field(default_factory=dict)
    before: float = 0.0
    after: float = 0.0

    def held_at(self, at: Array | float) -> Array:
        """Values (..., c) that hold at instants (...), s; the log must have lines."""
        return np.asarray(self.value[latest(self.time, at)])

    def linear_at(self, at: Array) -> Array:
        """Values (n, c) at instants (n,), s, straight from line to line (m > 0)."""
        return np.stack([np.interp(at, self.time, column) for column in self.value.T], axis=1)

    def within(self, begin: float, end: float) -> "Commands":
        """The lines between two times, s, with the one held at `begin` and the one after `end`."""
        first, last = np.searchsorted(self.time, [begin, end], side="right")
        at = slice(max(int(first) - 1, 0), int(last) + 1)
        return replace(self, time=self.time[at], value=self.value[at])

    def recording(self, edges: Array) -> tuple[float, float]:
        """When the whole recording began, and how long it lasted, s.

        Args:
            edges: (n,) s, of which the first and the last bound this part of the recording.
        """
        start = float(edges[0]) - self.before
        return start, float(edges[-1]) + self.after - start

    def since_start(self, times: Array) -> Array:
        """Times since the start of the whole recording, s.

        Args:
            times: s on the MoCap clock, of which the first is the beginning of this part.
        """
        return np.asarray(times - times[0] + self.before)


@dataclass(frozen=True, eq=False)
class Site:
    """Where a run was recorded.

    Attributes:
        tank: (3, 2), low and high walls along x, y, z of NED, m; NaN when unknown.
        axes: (3,), signs between the MoCap world axes and NED.
        level: z in NED at which a floating vehicle is at rest, m.
    """

    tank: Array
    axes: Array
    level: float = 0.0

    @staticmethod
    def unknown() -> "Site":
        """Make an unbounded site whose MoCap axes are NED."""
        return Site(np.full((3, 2), np.nan), np.ones(3))
