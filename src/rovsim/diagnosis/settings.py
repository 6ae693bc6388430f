"""How a diagnosis decides."""

from typing import Annotated

from pydantic import Field, PositiveInt

from rovsim.core.schema import Section
from rovsim.estimation.settings import MAX_TRAIN_SECONDS
from rovsim.simulation.settings import SimulationSettings

MostSeconds = Annotated[float, Field(ge=60)]


class SearchSettings(Section):
    """How effects are chosen.

    `false_alarm` is the chance of naming an effect where none is missing, per addition. `relevant`:
    an effect without which no axis' error in 2 s windows is larger by this share is left out,
    however sure it is: at that size the laboratory's clocks and roundings look like effects.
    Of train runs that last longer than `most_seconds` together, those parts are looked at that tell
    most. The search ends where the evidence ends; `most_effects` guards against one that does not.
    """

    false_alarm: Annotated[float, Field(gt=0, lt=1)] = 0.003
    draws: PositiveInt = 4000  # of noise alone, for the best gain by chance
    trials: PositiveInt = 3
    most_effects: PositiveInt = 12
    relevant: Annotated[float, Field(ge=0)] = 0.02
    most_seconds: MostSeconds = MAX_TRAIN_SECONDS


class DiagnosisSettings(SimulationSettings):
    """All that a diagnosis depends on but the runs and the model."""

    search: SearchSettings = SearchSettings()
    seed: int = Field(0, ge=0)
