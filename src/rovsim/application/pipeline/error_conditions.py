"""Under which conditions models fail."""

from typing import Sequence

from rovsim.application.sections import SimulationSettings
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.entries import list_conditions
from rovsim.evaluation.error_conditions.search import search_conditions
from rovsim.measurement.signals.motion import Motion
from rovsim.results.error_conditions import ErrorConditions


def find_error_conditions(
    models: Sequence[Model], motions: Sequence[Motion], settings: SimulationSettings
) -> ErrorConditions:
    """What the errors of models vary with, each on the runs it may be judged on."""
    return list_conditions(
        [
            search_conditions(model, motions, settings.signals, settings.replay)
            for model in counted(models, "searching")
        ]
    )
