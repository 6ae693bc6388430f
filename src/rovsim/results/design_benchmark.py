"""`CASE.json` of the benchmark of designs: what was promised, and what its flights told."""

from typing import ClassVar

from rovsim.core.schema import Section
from rovsim.results.base import Result, Sparse
from rovsim.results.experiment import Expected


class HiddenEffect(Section):
    """What was hidden in the tank, parameters in their own units."""

    effect: str
    parameters: dict[str, float]


class ThroughWall(Section):
    """A flight that left the tank; `left` says where."""

    left: str


class ReachedOdds(Section):
    """Natural logarithm of the odds of the truth against its rival, with the flight and before."""

    log_odds: float
    log_odds_before: float

    @property
    def told(self) -> float:
        """What flights are compared by."""
        return self.log_odds


class ReachedStd(Section):
    """A fitted value and its standard deviation with the flight, and the latter before.

    In the parameter's unit. `gained` is the information of the flight in units of what the run
    before held: (std_before/std)^2 - 1.
    """

    std: float
    std_before: float
    gained: float
    value: float

    @property
    def told(self) -> float:
        """What flights are compared by."""
        return self.gained


Outcome = ThroughWall | ReachedOdds | ReachedStd


class FlownCase(Result, Sparse):
    """One case: its design, and the usual manoeuvre that would tell most, both flown.

    `case` is a pair of rivals `a+b`, of which the first is hidden, or a value `effect.parameter`;
    `seconds` that the plan took by the clock, and of the processor; `expected_ratio`: how many
    times as much the design should tell as the best usual manoeuvre. Without `usual` where
    none stays within the limits.
    """

    noun: ClassVar[str] = "case of the benchmark of designs"
    command: ClassVar[str] = "`python -m rovsim.benchmarks.designs`"

    case: str
    seconds: float
    cpu_seconds: float
    manoeuvre: str
    hidden: tuple[HiddenEffect, ...]
    promised: Expected
    best_usual: str | None
    expected_ratio: float | None
    designed: Outcome
    usual: Outcome | None = None
