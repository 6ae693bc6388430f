"""Settings of a diagnosis: how it decides, and how runs are filtered and replayed."""

from typing import Annotated

from pydantic import Field, PositiveInt

from rovsim.core.schema import Section
from rovsim.estimation.settings import MAX_TRAIN_SECONDS
from rovsim.simulation.settings import SimulationSettings

MostSeconds = Annotated[float, Field(ge=60)]


class SearchSettings(Section):
    """How effects are chosen.

    Attributes:
        false_alarm: chance of accepting an effect where none is missing, for each addition.
        draws: of noise alone, from which the best gain by chance is estimated.
        trials: how many candidates are refitted for each addition or swap, at least.
        most_effects: a limit for a search that would not end; usually the evidence ends it.
        relevant: share of the error in 2 s windows. An effect without which the error of no axis is
            larger by this share is left out, however sure it is: at that size, the laboratory's
            clocks and roundings look like effects.
        most_seconds: of train runs that last longer together, only the most telling parts are used.
    """

    false_alarm: Annotated[float, Field(gt=0, lt=1)] = 0.003
    draws: PositiveInt = 4000  # of noise alone, for the best gain by chance
    trials: PositiveInt = 3
    most_effects: PositiveInt = 12
    relevant: Annotated[float, Field(ge=0)] = 0.02
    most_seconds: MostSeconds = MAX_TRAIN_SECONDS


class DiagnosisSettings(SimulationSettings):
    """All that a diagnosis depends on, except for the runs, the model and the catalogue.

    Attributes:
        search: how effects are chosen.
        seed: of all random draws.
    """

    search: SearchSettings = SearchSettings()
    seed: int = Field(0, ge=0)
