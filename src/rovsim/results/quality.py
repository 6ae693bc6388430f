"""`quality/RUN.json`: how good a recording is."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result


class Rate(Section):
    """Frames a second, Hz: as the file says, and as its times are."""

    nominal: float
    median: float


class Gap(Section):
    """A stretch without a pose, s."""

    start_s: float
    duration_s: float


class CommandSummary(Section):
    """What the command log holds."""

    kind: str
    lines: int
    start_s: float
    end_s: float
    median_step_s: float | None
    longest_step_s: float | None
    varies: bool


class Excitation(Section):
    """Standard deviation of the body velocity on one axis, and whether it suffices to judge it."""

    std: float
    unit: str
    excited: bool


class PoseNoise(Section):
    """Noise of one sample; None with too few."""

    position_m: float | None
    attitude_rad: float | None


class MeasuredChannel(Section):
    """What a channel holds: samples, usual rate, first and last time, components measured."""

    samples: int
    rate_hz: float | None
    start_s: float
    end_s: float
    measured: tuple[str, ...]


class Quality(Result):
    """One run.

    `repairs` counts what was mended, by kind; `outliers` is None when not looked for; `commands`
    None where nothing was commanded; `posed` whether full poses were measured, `channels` what was
    beside or instead of them; `excitation` of the measured axes; `unusable` says why a run cannot
    be used; `used`: the spans in s that alone are, empty where all is; `remarks` are sentences its
    owner can act on, of which `doubts` can make results wrong.
    """

    noun: ClassVar[str] = "quality report"
    command: ClassVar[str] = "the study"

    schema_: Literal["rovsim.quality/1"] = Field(default="rovsim.quality/1", alias="schema")
    run: str
    split: str
    control: str
    rate_hz: Rate
    duration_s: float
    frames: int
    not_found: int
    longest_gap_s: float
    gaps: tuple[Gap, ...]
    outliers: int | None
    repairs: dict[str, int]
    commands: CommandSummary | None
    posed: bool = True
    excitation: dict[str, Excitation]
    noise: PoseNoise
    unusable: str | None
    channels: dict[str, MeasuredChannel] = Field(default_factory=dict)
    used: tuple[tuple[float, float], ...] = ()
    doubts: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def others(self) -> tuple[str, ...]:
        """The remarks that are no doubts."""
        return self.remarks[len(self.doubts) :]

    def doubted(self, *more: str) -> "Quality":
        """The same with further doubts, which are remarks as well, the first of them."""
        doubts = (*self.doubts, *more)
        return self.model_copy(update={"doubts": doubts, "remarks": (*doubts, *self.others)})

    @property
    def excited(self) -> tuple[str, ...]:
        """Axes that moved enough to be judged."""
        return tuple(axis for axis, excitation in self.excitation.items() if excitation.excited)
