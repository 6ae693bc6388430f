"""What a design may be asked, and limits that a flight keeps to."""

from typing import Annotated, Sequence

from pydantic import Field, NonNegativeFloat, PositiveFloat, field_validator

from rovsim.core.schema import Section, checked
from rovsim.diagnosis.settings import DiagnosisSettings, MostSeconds
from rovsim.estimation.settings import MAX_TRAIN_SECONDS
from rovsim.simulation.settings import SimulationSettings

# s: shorter shows little; longer nobody foresees, and a search over it would fill the memory
MIN_FLIGHT_SECONDS, MAX_FLIGHT_SECONDS = 10, 600


class FlightLimits(Section):
    """What a flight keeps to, in whatever the posterior holds for possible.

    `clearance` m of CO from walls, floor and surface: the vehicle's own half length, and a hand's
    breadth. `speed` m/s and `turn_rate` rad/s are what small vehicles reach; `tilt` rad is as far
    as cameras on the walls see all markers. `slew` shares of the full stick per second: a thumb
    moves a stick from end to end in 0.4 s. `depth` m below the surface, where less than the
    tank allows is wanted: the least and the largest.
    """

    clearance: NonNegativeFloat = 0.4
    speed: PositiveFloat = 1.0
    turn_rate: PositiveFloat = 1.5
    tilt: PositiveFloat = 0.5
    slew: PositiveFloat = 5.0
    depth: tuple[NonNegativeFloat, NonNegativeFloat] | None = None

    @field_validator("depth")
    @classmethod
    def _is_below(cls, depth: tuple[float, float] | None) -> tuple[float, float] | None:
        if depth and depth[0] >= depth[1]:
            raise ValueError("two depths in m below the surface, the lesser one first")
        return depth


class DesignSettings(Section):
    """How a flight is looked for: `population` flights in each of `rounds` rounds."""

    limits: FlightLimits = FlightLimits()
    population: Annotated[int, Field(ge=8, le=10_000)] = 96
    rounds: Annotated[int, Field(ge=1, le=1000)] = 12


class Question(SimulationSettings):
    """What is asked, on which settings of signals and replays it depends, and the seed.

    `between` two effects; `know` parameters, as `effect.parameter`. `most_seconds` of the train
    runs are looked at.
    """

    between: tuple[str, ...] = ()
    know: tuple[str, ...] = ()
    seconds: Annotated[float, Field(ge=MIN_FLIGHT_SECONDS, le=MAX_FLIGHT_SECONDS)] = 60.0
    design: DesignSettings = DesignSettings()
    most_seconds: MostSeconds = MAX_TRAIN_SECONDS
    seed: int = Field(0, ge=0)

    @staticmethod
    def of(
        settings: DiagnosisSettings,
        design: DesignSettings,
        where: str,
        *,
        seconds: float,
        between: Sequence[str] = (),
        know: Sequence[str] = (),
    ) -> "Question":
        """What is asked of a campaign that is cleaned, and looked at, as a diagnosis would.

        Args:
            settings: of that diagnosis.
            design: how the flight is looked for.
            where: who asks, for messages.
            seconds: that the flight lasts.
            between: two effects, by their ids.
            know: parameters, as `effect.parameter`.

        Raises:
            BadInput: it is no question.
        """
        content = {
            "signals": settings.signals,
            "replay": settings.replay,
            "between": between,
            "know": know,
            "seconds": seconds,
            "design": design,
            "most_seconds": settings.search.most_seconds,
            "seed": settings.seed,
        }
        return checked(Question, content, where)
