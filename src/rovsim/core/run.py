"""Which run a thing belongs to, what was commanded, and where it was: known to all rooms."""

from dataclasses import dataclass, field, replace
from typing import Literal, Mapping

import numpy as np
from numpy import ndarray as Array

CommandKind = Literal["thruster", "demand", "wrench"]
Between = Literal["held", "linear"]  # what commands do between two logged lines


def latest(time: Array, at: Array | float) -> Array:
    """Which of the lines at `time` (m,), increasing, holds at each instant; before all, the first.

    A line holds from its own instant on; add a tolerance to `at` where these two are computed in
    different ways.
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
    """What the pilot sent. A line holds until the next one.

    `time` (m,) in s on the MoCap clock, increasing. `value` (m, c): commands of the thrusters in
    [-1, 1] and angles in rad, as `Vehicle.command_columns` says (`thruster`), demands per axis in
    [-1, 1] (`demand`) or a body wrench in N, N m (`wrench`). `auxiliary`: what else was logged, by
    name; `voltage` is that of the battery in V. Where this is a part of a recording, `before` and
    `after` are the s of it that lie on either side.
    Without lines (m = 0) nothing was commanded: free decay, towing, drifting.
    """

    time: Array
    value: Array
    kind: CommandKind
    auxiliary: Mapping[str, Logged] = field(default_factory=dict)
    before: float = 0.0
    after: float = 0.0

    def held_at(self, at: Array | float) -> Array:
        """Values (..., c) that hold at instants (...) s, of a log that has lines."""
        return np.asarray(self.value[latest(self.time, at)])

    def within(self, begin: float, end: float) -> "Commands":
        """The lines between two times, and one on either side: what holds then, what comes next."""
        first, last = np.searchsorted(self.time, [begin, end], side="right")
        at = slice(max(int(first) - 1, 0), int(last) + 1)
        return replace(self, time=self.time[at], value=self.value[at])

    def recording(self, edges: Array) -> tuple[float, float]:
        """When the recording began and how long it lasted, s; steps between `edges` cover this."""
        start = float(edges[0]) - self.before
        return start, float(edges[-1]) + self.after - start

    def since_start(self, times: Array) -> Array:
        """Times as s since the start of the recording; the first is where this begins."""
        return np.asarray(times - times[0] + self.before)


@dataclass(frozen=True, eq=False)
class Site:
    """Where it was recorded: `tank` (3, 2) low and high walls in NED m (NaN when unknown).

    `axes` (3,) are the signs between the MoCap world axes and NED. `level` m NED: where a vehicle
    that floats is at rest.
    """

    tank: Array
    axes: Array
    level: float = 0.0

    @staticmethod
    def unknown() -> "Site":
        """An unbounded place whose MoCap axes are NED."""
        return Site(np.full((3, 2), np.nan), np.ones(3))
