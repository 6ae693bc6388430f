"""What a reader of a format returns."""

from dataclasses import dataclass, field
from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import CommandKind, Logged
from rovsim.measurement.recording.channels import Channels
from rovsim.measurement.recording.repairs import CommandRepairs, MotionRepairs


@dataclass(frozen=True, eq=False)
class Export:
    """The measurements of a file, in the file's own axes and order of lines.

    Attributes:
        time: (n,) s.
        position: (n, 3) m.
        attitude: (n, 4), unit quaternion (w, x, y, z) from body to world.
        tracked: bool (n,), False where the body was not seen.
        rate: nominal rate, Hz; None when the file does not say.
        nu: (n, 6), body velocities, m/s and rad/s; None when not exported.
        repairs: number of lines that were repaired or left out.
        channels: further measured channels.
        notes: sentences about the file that its owner should read.
    """

    time: Array
    position: Array
    attitude: Array
    tracked: Array
    rate: float | None = None
    nu: Array | None = None
    repairs: MotionRepairs = field(default_factory=MotionRepairs)
    channels: Channels = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @staticmethod
    def of_channels(
        channels: Channels, repairs: MotionRepairs | None = None, notes: tuple[str, ...] = ()
    ) -> "Export":
        """Make the export of a file without full poses."""
        return Export(
            np.empty(0),
            np.empty((0, 3)),
            np.empty((0, 4)),
            np.empty(0, bool),
            repairs=repairs or MotionRepairs(),
            channels=channels,
            notes=notes,
        )


@dataclass(frozen=True, eq=False)
class CommandExport:
    """The commands of a file, with lines in the order of the file.

    Attributes:
        time: (m,) s.
        value: (m, c), as in `rovsim.core.run.Commands`.
        kind: what the commands drive.
        repairs: number of lines that were repaired or left out.
        notes: sentences about the file that its owner should read.
        auxiliary: further logged numbers, by name.
    """

    time: Array
    value: Array
    kind: CommandKind
    repairs: CommandRepairs = field(default_factory=CommandRepairs)
    notes: tuple[str, ...] = ()
    auxiliary: Mapping[str, Logged] = field(default_factory=dict)
