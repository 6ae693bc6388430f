"""What looks like a log of commands, before anybody has said what it is."""

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.campaign_file import CommandLog, LoggedKind


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
class FoundCommands:
    """What looks like commands in one file.

    Attributes:
        candidates: to choose from, the likeliest first.
        notes: sentences for the user.
        unknown: a text on what may be commands and cannot be read; empty where there is nothing.
    """

    candidates: tuple[CommandCandidate, ...] = ()
    notes: tuple[str, ...] = ()
    unknown: str = ""
