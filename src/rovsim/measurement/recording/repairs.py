"""How many lines of raw files were repaired or left out, for each reason."""

from dataclasses import asdict, astuple, dataclass
from pathlib import Path

from pydantic import TypeAdapter

from rovsim.core.files import plain, read_json, write_json


@dataclass(frozen=True)
class MotionRepairs:
    """Repairs of the measurements of a run; those of several files add up.

    Attributes:
        duplicates: lines that repeated a time and were left out.
        unsorted: steps back in time, which were sorted.
        cut_lines: last lines that were cut short and left out.
        bad_rotations: frames that hold no rotation and count as not found.
        wrong_header_rate: 1 if the header's rate does not agree with the times.
    """

    duplicates: int = 0
    unsorted: int = 0
    cut_lines: int = 0
    bad_rotations: int = 0
    wrong_header_rate: int = 0

    def __add__(self, other: "MotionRepairs") -> "MotionRepairs":
        pairs = zip(astuple(self), astuple(other), strict=True)
        return MotionRepairs(*(one + another for one, another in pairs))


@dataclass(frozen=True)
class CommandRepairs:
    """Repairs of the commands of a run.

    Attributes:
        duplicates: lines that repeated a time and were left out.
        unsorted: steps back in time, which were sorted.
        cut_lines: last lines that were cut short and left out.
        dropped: lines without a value, which were left out.
        clipped: lines beyond [-1, 1], which were limited to it.
        long_steps: steps that are longer than usual; the line before is held over them.
    """

    duplicates: int = 0
    unsorted: int = 0
    cut_lines: int = 0
    dropped: int = 0
    clipped: int = 0
    long_steps: int = 0


@dataclass(frozen=True)
class Anomalies:
    """What was repaired or noticed while the files of a run were read.

    Attributes:
        motion: repairs of the measurements.
        commands: repairs of the commands.
        left_out: number of lines of the measurements outside of the used spans.
        used: the spans [from, to] that are used, s; empty where all is.
        notes: sentences of the readers about their files.
    """

    motion: MotionRepairs = MotionRepairs()
    commands: CommandRepairs = CommandRepairs()
    left_out: int = 0
    used: tuple[tuple[float, float], ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def counts(self) -> dict[str, int]:
        """All numbers of lines, by their names in `quality/RUN.json`."""
        commands = {f"command_{name}": count for name, count in asdict(self.commands).items()}
        return {**asdict(self.motion), **commands, "left_out": self.left_out}

    def write(self, path: Path) -> None:
        """Write to JSON."""
        write_json(path, plain(asdict(self)))

    @staticmethod
    def read(path: Path) -> "Anomalies":
        """Read what `write` wrote."""
        return TypeAdapter(Anomalies).validate_python(read_json(path))
