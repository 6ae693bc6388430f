"""What a file holds: motions, and what looks like commands."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.intake.survey.sizes import Key, Unit
from rovsim.measurement.campaign_file import CommandLog
from rovsim.measurement.recording.exports import Export

LoggedKind = Literal["pwm", "normalized", "demand", "wrench"]


@dataclass(frozen=True, eq=False)
class Track:
    """The motion of one body or topic, sorted by time, in the file's own axes.

    `body` as `mocap.body` names it, empty where the format has none; `topics` of a bag by what is
    read of them.
    """

    body: str
    export: Export
    topics: Mapping[str, str] = field(default_factory=dict)

    @property
    def posed(self) -> bool:
        """Whether there are full poses."""
        return bool(self.export.found.any())

    @property
    def start(self) -> float:
        """First time, s."""
        return float(self.export.time[0])

    @property
    def end(self) -> float:
        """Last time, s."""
        return float(self.export.time[-1])


@dataclass(frozen=True, eq=False)
class CommandCandidate:
    """What looks like commands: `time` (m,) s and `value` (m, c) as logged.

    `kind` None: their size does not say; `asked`: it is only the likeliest. `said` is how the rest
    is known. `axes` and `topic` as in the section `commands`; `rest` are other columns of numbers
    (m,), such as angles of fins.
    """

    format: str
    columns: tuple[str, ...]
    time: Array
    value: Array
    kind: LoggedKind | None
    said: str
    topic: str | None = None
    axes: tuple[str, ...] = ()
    auxiliary: tuple[str, ...] = ()
    rest: Mapping[str, Array] = field(default_factory=dict)
    asked: bool = False

    def of(self, names: Sequence[str]) -> Array:
        """Columns (m, len(names)) by their names, of all that there are."""
        known = dict(zip(self.bare, self.value.T, strict=True)) | dict(self.rest)
        return np.stack([known[name] for name in names], axis=1)

    @property
    def bare(self) -> tuple[str, ...]:
        """Columns without the minus that turns their sign."""
        return tuple(name.removeprefix("-") for name in self.columns)

    def log(
        self, columns: tuple[str, ...] | None = None, kind: LoggedKind | None = None
    ) -> CommandLog:
        """The section `commands` that reads it."""
        content: dict[str, Any] = {
            "format": self.format,
            "kind": kind or self.kind,
            "columns": list(columns or self.columns),
        }
        content |= {"axes": list(self.axes)} if self.axes else {}
        content |= {"topic": self.topic} if self.topic else {}
        content |= {"auxiliary": list(self.auxiliary)} if self.auxiliary else {}
        return CommandLog(**content)

    @property
    def moves(self) -> bool:
        """Whether any column changes."""
        return bool(len(self.value) > 1 and np.nanmax(np.ptp(self.value, axis=0), initial=0.0) > 0)


@dataclass(frozen=True, eq=False)
class Contents:
    """One file (or bag folder): its format, motions to choose from, commands to choose from.

    `path` is what the readers open; `original` the file that was named, another one where only a
    copy with other column names can be read. `notes` are sentences for its owner. `beside`: other
    files of the same run, whose sensors are joined in the track. `unknown`: columns of numbers that
    are nothing that is known, where there are no commands. `unread`: columns that are no channel;
    some may be commands. `units`: those that the size of its numbers tells, by names of columns.
    `doubts`: what looks wrong in the file.
    """

    path: Path
    format: str
    tracks: tuple[Track, ...] = ()
    drives: tuple[CommandCandidate, ...] = ()
    original: Path | None = None
    notes: tuple[str, ...] = ()
    beside: tuple["Contents", ...] = ()
    unknown: str = ""
    unread: tuple[str, ...] = ()
    units: Mapping[Key, Unit] = field(default_factory=dict)
    doubts: tuple[str, ...] = ()

    @property
    def files(self) -> tuple["Contents", ...]:
        """The file, and those beside it."""
        return (self, *self.beside)

    @property
    def named(self) -> Path:
        """The file as its owner knows it."""
        return self.original or self.path
