"""Which run a thing belongs to, what was commanded, and where it was: known to all rooms."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy import ndarray as Array

CommandKind = Literal["thruster", "demand", "wrench"]


@dataclass(frozen=True)
class RunInfo:
    """Which run this is: its `id`, `control` (3dof | 6dof) and `split` (train | test)."""

    id: str
    control: str
    split: str


@dataclass(frozen=True, eq=False)
class Commands:
    """What the pilot sent. A line holds until the next one.

    `time` (m,) in s on the MoCap clock, increasing. `value` (m, c): thruster commands in [-1, 1]
    (`thruster`), demands per axis in [-1, 1] (`demand`) or a body wrench in N, N m (`wrench`).
    Without lines (m = 0) nothing was commanded: free decay, towing, drifting.
    """

    time: Array
    value: Array
    kind: CommandKind


@dataclass(frozen=True, eq=False)
class Site:
    """Where it was recorded: `tank` (3, 2) low and high walls in NED m (NaN when unknown).

    `axes` (3,) are the signs between the MoCap world axes and NED.
    """

    tank: Array
    axes: Array

    @staticmethod
    def unknown() -> "Site":
        """An unbounded place whose MoCap axes are NED."""
        return Site(np.full((3, 2), np.nan), np.ones(3))
