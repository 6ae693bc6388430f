"""`experiment.json`: the flight that tells most, and what it is expected to tell."""

from typing import ClassVar, Literal

from pydantic import Field

from rovsim.core.schema import Section
from rovsim.results.base import Result, Sparse


class Surer(Sparse):
    """Standard deviation of a value `now`, and `then`: with the flight beside the train runs.

    `gained` is the information of the flight in units of what the runs hold: (now/then)^2 - 1.
    """

    now: float | None
    then: float | None
    unit: str | None = None
    gained: float | None = None


class RivalOdds(Section):
    """Odds of one rival against the other: `now`, and expected `then` if it is the true one.

    `log_odds` are their natural logarithms.
    """

    now: float
    then: float
    log_odds_now: float
    log_odds_then: float


class Expected(Section):
    """What a flight tells: odds by rival, standard deviations by `effect.parameter`."""

    odds: dict[str, RivalOdds] = Field(default_factory=dict)
    std: dict[str, Surer] = Field(default_factory=dict)


class UsualManoeuvre(Expected):
    """A usual manoeuvre on the same seconds, at the amplitudes at which it tells most.

    `amplitude` in the plane and out of it, shares of the full stick; None where none stays within
    the limits. `designed_is_better`: how many times as much the designed flight tells, in log odds
    or information (the geometric mean over what was asked).
    """

    amplitude: tuple[float, float] | None
    designed_is_better: float | None


class Start(Section):
    """Where a flight begins, at rest and level: m and rad in the recordings' world axes."""

    x_m: float
    y_m: float
    z_m: float
    yaw_rad: float


class Keeps(Section):
    """Limits that the flight keeps to, as predicted over what is not yet known.

    `nearest_wall_m` is the least distance of CO from a wall, floor or surface, None where none is
    known; `speed_m_s`, `turn_rate_rad_s` and `tilt_rad` the largest.
    """

    nearest_wall_m: float | None
    speed_m_s: float
    turn_rate_rad_s: float
    tilt_rad: float


class Experiment(Result):
    """A designed flight; its commands stand in `commands`, beside this file.

    `commands_sha256` says of which bytes: the start of one plan is not that of another's commands.
    """

    noun: ClassVar[str] = "designed flight"
    command: ClassVar[str] = "`rovsim design`"

    schema_: Literal["rovsim.experiment/1"] = Field(default="rovsim.experiment/1", alias="schema")
    seconds: float
    model: str
    between: tuple[str, ...] = ()
    know: tuple[str, ...] = ()
    commands: str = "experiment.csv"
    commands_sha256: str | None = None
    start: Start
    manoeuvre: str
    expects: Expected
    baselines: dict[str, UsualManoeuvre]
    keeps: Keeps
    instructions: tuple[str, ...]
    warnings: tuple[str, ...] = ()
