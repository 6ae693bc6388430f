"""`summary.json` of the blind benchmark: how often each method is right."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result


class Rates(Section):
    """Shares of `cases`, and medians; None of nothing.

    `first`: the first name is right; `exact`: the names are, and nothing else is named; `strict`:
    not counting as right what the method calls indistinguishable from it; `alike`: mean size of
    those groups; `seconds` an answer; `parameters` judged, their relative errors, and how often the
    95 % intervals hold.
    """

    cases: int
    verdict: float | None
    first_strict: float | None
    first: float | None
    exact_strict: float | None
    exact: float | None
    false_names_strict: float | None
    false_names: float | None
    unexplained: float | None
    alike: float | None
    redrawn: float | None
    seconds: float | None
    parameters: int
    error_median: float | None
    error_95: float | None
    coverage: float | None


class EffectRates(Rates):
    """Of one effect hidden alone; `limit`: the strength at which half are named."""

    limit: float | None
    instead: tuple[str, ...]


class MethodSummary(Section):
    """One method: by kind of case, by effect, and by physics outside the catalogue."""

    cases: int
    failed: tuple[str, ...]
    kinds: dict[str, Rates]
    effects: dict[str, EffectRates]
    outside: dict[str, Rates]


class BlindSummary(Result):
    """All methods on one suite."""

    noun: ClassVar[str] = "summary of the blind benchmark"
    command: ClassVar[str] = "the blind benchmark"

    schema_: Literal["rovsim.blind.summary/1"] = Field(
        default="rovsim.blind.summary/1", alias="schema"
    )
    suite: str
    seeds: str
    methods: dict[str, MethodSummary]
