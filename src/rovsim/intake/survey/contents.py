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

    Attributes:
        body: as `mocap.body` names it; empty where the format has no bodies.
        export: times, poses and channels of sensors.
        topics: of a bag without poses, by the key of `mocap.topics` for which they are read.
    """

    body: str
    export: Export
    topics: Mapping[str, str] = field(default_factory=dict)

    @property
    def posed(self) -> bool:
        """Whether there are full poses (position and attitude)."""
        return bool(self.export.tracked.any())

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
    """What looks like a log of commands.

    Attributes:
        format: of the file.
        columns: names of the c columns; a leading minus turns the sign.
        time: (m,) s.
        value: (m, c) as logged.
        kind: None where the size of the numbers does not tell it.
        reason: how the kind is known.
        topic: of a bag, as in the section `commands`.
        axes: of demands or a wrench, as in the section `commands`.
        auxiliary: other columns that are kept, such as the voltage.
        rest: other columns of numbers (m,), such as angles of fins, by name.
        asked: whether the kind is only the likeliest, and has to be asked for.
    """

    format: str
    columns: tuple[str, ...]
    time: Array
    value: Array
    kind: LoggedKind | None
    reason: str
    topic: str | None = None
    axes: tuple[str, ...] = ()
    auxiliary: tuple[str, ...] = ()
    rest: Mapping[str, Array] = field(default_factory=dict)
    asked: bool = False

    def of(self, names: Sequence[str]) -> Array:
        """Return columns (m, len(names)) by their names, those of `rest` included."""
        by_name = dict(zip(self.bare, self.value.T, strict=True)) | dict(self.rest)
        return np.stack([by_name[name] for name in names], axis=1)

    @property
    def bare(self) -> tuple[str, ...]:
        """Names of columns, without the minus that turns their sign."""
        return tuple(name.removeprefix("-") for name in self.columns)

    def log(
        self, columns: tuple[str, ...] | None = None, kind: LoggedKind | None = None
    ) -> CommandLog:
        """Return the section `commands` of campaign.yaml that reads this log.

        Args:
            columns: names to read; None: all.
            kind: of the commands; None: that of this candidate.
        """
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
        """Whether any column changes over time."""
        return bool(len(self.value) > 1 and np.nanmax(np.ptp(self.value, axis=0), initial=0.0) > 0)


@dataclass(frozen=True, eq=False)
class Contents:
    """What one file or bag folder holds.

    Attributes:
        path: what the readers open.
        format: as `mocap.format` names it.
        tracks: motions to choose from.
        drives: commands to choose from.
        original: the file that the user named, where `path` is a copy with other column names.
        notes: sentences for the user.
        beside: other files of the same run, whose sensors are joined in the track.
        unknown: if there are no commands, a text on columns of numbers that rovsim does not know.
        unread: columns that are no measured channel; some may be commands.
        units: that the size of the numbers tells, by names of columns.
        doubts: sentences on what looks wrong in the file.
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
        """This file and the other files of its run."""
        return (self, *self.beside)

    @property
    def named(self) -> Path:
        """The path that the user knows."""
        return self.original or self.path
