"""The contents of an ArduPilot log: arrays of numbers for each type of message."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput

DOWNLOAD_AGAIN = "Download it again from the vehicle or the ground station."


@dataclass(frozen=True, eq=False)
class Series:
    """The n messages of one type: `time` (n,) s on the clock of the log, numbers (n,) by field."""

    time: Array
    fields: Mapping[str, Array]

    def of(self, names: Sequence[str]) -> Array:
        """Numbers (n, c) of c fields by name; NaN for fields that the messages have not."""
        missing = np.full(len(self.time), np.nan)
        return np.stack([self.fields.get(name, missing) for name in names], axis=1)

    def where(self, kept: Array) -> "Series":
        """The messages that a mask or index array selects."""
        return Series(self.time[kept], {name: v[kept] for name, v in self.fields.items()})


@dataclass(frozen=True, eq=False)
class ArduPilotLog:
    """What was read of a log.

    Attributes:
        path: the file.
        kind: `dataflash` or `telemetry`.
        series: messages by type.
        submarine: whether the vehicle is one; None where the log does not say.
        notes: sentences about the file.
    """

    path: Path
    kind: str
    series: Mapping[str, Series]
    submarine: bool | None = None
    notes: tuple[str, ...] = ()


def no_log(path: Path, found: str) -> BadInput:
    """Make the error for a file that is not an ArduPilot log."""
    return BadInput(
        found,
        where=path,
        expected="an ArduPilot log: dataflash (.BIN) or telemetry (.tlog)",
        remedy=DOWNLOAD_AGAIN,
    )
