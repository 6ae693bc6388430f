"""Find the conditions under which a model fails."""

from typing import Sequence

from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.entries import list_conditions
from rovsim.evaluation.error_conditions.search import ConditionSearch
from rovsim.measurement.signals.motion import Motion
from rovsim.results.error_conditions import ErrorConditions
from rovsim.simulation.settings import SimulationSettings


def find_error_conditions(
    model: Model, motions: Sequence[Motion], settings: SimulationSettings
) -> ErrorConditions:
    """Find conditions with which the errors of a model vary, over some runs."""
    splits = [motion.run.split for motion in motions]
    search = ConditionSearch(model, splits, settings)
    for motion in counted(motions, "searching"):
        search.add_run(motion)
    return list_conditions([search.result])
