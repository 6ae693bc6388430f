"""Under which conditions models fail."""

from typing import Any, Sequence

from rovsim.application.sections import SimulationSettings
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions import content, judged
from rovsim.measurement.signals.motion import Motion


def find_error_conditions(
    models: Sequence[Model], motions: Sequence[Motion], settings: SimulationSettings
) -> dict[str, Any]:
    """`where.json` of models, each on the runs it may be judged on."""
    return content(
        [
            judged(model, motions, settings.signals, settings.replay)
            for model in counted(models, "searching")
        ]
    )
