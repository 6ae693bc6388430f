"""What a file holds: motions, and what looks like commands."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Mapping

from rovsim.core.errors import BadInput
from rovsim.intake.survey.sizes import Key, Unit
from rovsim.measurement.recording.candidates import CommandCandidate
from rovsim.measurement.recording.exports import Export
from rovsim.measurement.recording.tidying import tidy_export


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

    @staticmethod
    def of(
        body: str, export: Export, path: Path, topics: Mapping[str, str] | None = None
    ) -> "Track":
        """Sort what was read from a file; `body` and `topics` as above.

        Raises:
            BadInput: nothing was measured, or the body was never found.
            SeveralRuns: the times start again.
        """
        tidied = tidy_export(export, path)
        if not tidied.tracked.any() and not tidied.channels:
            raise BadInput(
                f"no frame in which the body was found ({len(export.time)} lines)",
                where=path,
                expected="a run with the body in sight",
                remedy="Export the run again, or take it out of 'runs'.",
            )
        return Track(body, tidied, topics or {})

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
