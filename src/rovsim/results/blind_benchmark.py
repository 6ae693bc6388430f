"""`summary.json` of the blind benchmark: how often each method is right."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result


class Rates(Section):
    """Shares of `cases`, and medians; None of nothing.

    `first`: the first name is right; `exact`: the names are, and nothing else is named; `strict`:
    not counting as right what the method calls indistinguishable from it; `alike`: mean size of
    those groups; `unseen`: not exact, as the runs cannot show what is not named, and so it says;
    `worse`: the model it ends with is worse than the nominal on test runs by more
    than 2 %; `seconds` an answer takes, wall and CPU, the median and what 95 % stay below;
    `parameters` judged, their relative errors, and how often the 95 % intervals hold.
    """

    cases: int
    verdict: float | None
    first_strict: float | None
    first: float | None
    exact_strict: float | None
    exact: float | None
    unseen: float | None
    false_names_strict: float | None
    false_names: float | None
    unexplained: float | None
    alike: float | None
    redrawn: float | None
    worse: float | None
    seconds: float | None
    seconds_95: float | None
    cpu_seconds: float | None
    cpu_seconds_95: float | None
    parameters: int
    error_median: float | None
    error_95: float | None
    coverage: float | None


class EffectRates(Rates):
    """Of one effect hidden alone; `limit`: the strength at which half are named."""

    limit: float | None
    instead: tuple[str, ...]


class Ranks(Section):
    """Where true values lie in what was said of them: `counts` (10,) of Φ((truth - value) / std).

    `covered` by 95 % intervals; `stretch`: by what intervals would have to be wider to cover 95 %;
    `p_value`: chance of counts as uneven as these if intervals are honest, None of too few.
    """

    values: int
    covered: float | None
    stretch: float | None
    counts: tuple[int, ...]
    p_value: float | None


class Claims(Section):
    """Names of which a probability between `low` and `high` was claimed, its mean, how many are
    `right`; no limits where none was claimed."""

    low: float | None
    high: float | None
    names: int
    right: int
    claimed: float | None


class BandRates(Section):
    """What 90 % bands hold at the ends of windows on test runs: share of `points` (one an axis).

    `low` and `high`: between these lies that share in nine of ten `campaigns`.
    """

    campaigns: int
    points: int
    inside: float
    low: float
    high: float


class Calibration(Section):
    """Whether intervals and probabilities are honest: all, by effect, by `effect.parameter`.

    `bands` by the length of the windows in s.
    """

    ranks: Ranks
    effects: dict[str, Ranks]
    parameters: dict[str, Ranks]
    probability: tuple[Claims, ...]
    without_probability: Claims
    bands: dict[str, BandRates] = Field(default_factory=dict)


class LawRates(Section):
    """Equations for one law: shares of `cases` that end `unexplained`, and have a proposal.

    `right`: its largest term acts where the law does, and its terms there are made of the law's
    quantities, no more, no fewer; `half`: it takes the error on test runs at least half of the way
    from the selected effects to the floor.
    """

    cases: int
    unexplained: float
    proposed: float
    right: float
    half: float


class MethodSummary(Section):
    """One method: by kind of case, by effect, by physics outside the catalogue, by law."""

    cases: int
    failed: tuple[str, ...]
    kinds: dict[str, Rates]
    effects: dict[str, EffectRates]
    outside: dict[str, Rates]
    calibration: Calibration
    laws: dict[str, LawRates] = Field(default_factory=dict)


class BlindSummary(Result):
    """All methods on one suite, or on a random `share` of its cases."""

    noun: ClassVar[str] = "summary of the blind benchmark"
    command: ClassVar[str] = "the blind benchmark"

    schema_: Literal["rovsim.blind.summary/1"] = Field(
        default="rovsim.blind.summary/1", alias="schema"
    )
    suite: str
    share: float = 1.0
    seeds: str
    simulator: str = "tank"
    methods: dict[str, MethodSummary]
