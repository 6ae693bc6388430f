"""What a reader of a format returns."""

from dataclasses import dataclass, field
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import CommandKind, Logged
from rovsim.measurement.recording.channels import Channels


@dataclass(frozen=True, eq=False)
class Export:
    """What was measured as a file tells it: its own axes, its own order of lines.

    `time` (n,) s; `position` (n, 3) m; `attitude` (n, 4) quaternion, body to world; `found` (n,)
    False where the body was not seen; `rate` nominal Hz, None when the file does not say; `nu`
    (n, 6) body velocities, None when not exported; `counts` of what was repaired while reading
    (`cut_lines`, `bad_rotations`); `channels` what else was measured; `notes` are sentences about
    the file that its owner should read.
    """

    time: Array
    position: Array
    attitude: Array
    found: Array
    rate: float | None = None
    nu: Array | None = None
    counts: dict[str, int] = field(default_factory=dict)
    channels: Channels = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @staticmethod
    def of_channels(
        channels: Channels, counts: dict[str, int] | None = None, notes: tuple[str, ...] = ()
    ) -> "Export":
        """What holds no full poses."""
        return Export(
            np.empty(0),
            np.empty((0, 3)),
            np.empty((0, 4)),
            np.empty(0, bool),
            counts=counts or {},
            channels=channels,
            notes=notes,
        )


@dataclass(frozen=True, eq=False)
class CommandExport:
    """Commands as a file tells them: `time` (m,) s, `value` (m, c), lines in file order.

    `counts` of what was repaired while reading (`cut_lines`, `dropped`, `clipped`); `notes` are
    sentences about the file that its owner should read. `auxiliary`: what else was logged, by name.
    """

    time: Array
    value: Array
    kind: CommandKind
    counts: dict[str, int] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    auxiliary: Mapping[str, Logged] = field(default_factory=dict)
