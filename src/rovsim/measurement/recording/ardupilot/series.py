"""What a log holds of one type of message."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput

RE_RECORD = "Download it again from the vehicle or the ground station."


@dataclass(frozen=True, eq=False)
class Series:
    """Messages of one type: `time` (n,) s on the clock of the log, numbers (n,) by field."""

    time: Array
    fields: Mapping[str, Array]

    def of(self, names: Sequence[str]) -> Array:
        """Fields (n, len(names)); NaN where the messages have none of that name."""
        missing = np.full(len(self.time), np.nan)
        return np.stack([self.fields.get(name, missing) for name in names], axis=1)

    def where(self, kept: Array) -> "Series":
        """Some of the messages (n,)."""
        return Series(self.time[kept], {name: v[kept] for name, v in self.fields.items()})


@dataclass(frozen=True, eq=False)
class ArduPilotLog:
    """A log: its kind (`dataflash`, `telemetry`), series by type of message, and what to know.

    `submarine` is None where the log does not say what the vehicle is.
    """

    path: Path
    kind: str
    series: Mapping[str, Series]
    submarine: bool | None = None
    notes: tuple[str, ...] = ()


def no_log(path: Path, found: str) -> BadInput:
    """The message for a file that is no such log."""
    return BadInput(
        found,
        where=path,
        expected="an ArduPilot log: dataflash (.BIN) or telemetry (.tlog)",
        remedy=RE_RECORD,
    )
