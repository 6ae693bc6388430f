"""`timing.json` and `bench.json`: how long predictions and replays take."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result, Sparse

CONTROL_RATES_HZ = (50, 100, 250, 1000)  # from a surface pilot's to a motor controller's


class Latency(Sparse):
    """Time of one prediction, one call at a time after warm-up.

    `points` the predictor looks at; `misses`: calls slower than the period at each rate in Hz;
    `largest_difference` from and `times_faster` than other ways to predict the same, by their name.
    """

    points: int
    features: int
    outputs: int
    calls: int
    median_us: float
    p99_us: float
    p999_us: float
    max_us: float
    misses: dict[str, int]
    largest_difference: dict[str, float] = Field(default_factory=dict)
    times_faster: dict[str, float] = Field(default_factory=dict)


class BothWays(Section):
    """A trained residual's own library call, None where it has no library, and its export."""

    library: Latency | None = None
    exported: Latency

    @property
    def measured(self) -> dict[str, Latency]:
        """The ways that were timed, by name."""
        ways = {"library": self.library, "exported": self.exported}
        return {way: latency for way, latency in ways.items() if latency is not None}


class Timing(Result):
    """Latency of trained residuals, by model."""

    noun: ClassVar[str] = "timing"
    command: ClassVar[str] = "the study"

    inference: dict[str, BothWays]


class RemainingRms(Section):
    """RMS of what a correction leaves over that of the residual: mean and worst of the axes."""

    mean: float
    worst: float


class Accuracy(Section):
    """Error against cost of one way to learn: on runs as it was taught with, and on others."""

    name: str
    points: int
    fades: bool
    median_us: float
    seen: RemainingRms
    unseen: RemainingRms


class Bench(Result):
    """Speed on one machine: `replay` in steps a second, `inference` by name@points."""

    noun: ClassVar[str] = "speed benchmark"
    command: ClassVar[str] = "`rovsim bench`"

    schema_: Literal["rovsim.bench/1"] = Field(default="rovsim.bench/1", alias="schema")
    machine: str
    replay: dict[str, float]
    inference: dict[str, Latency]
    scheduling: str
    accuracy: tuple[Accuracy, ...]
