"""Replays, scores, conditions of the error and forces of some models, together."""

from typing import Sequence

from rovsim.application.pipeline.error_conditions import find_error_conditions
from rovsim.application.pipeline.forces import balance_run
from rovsim.application.pipeline.recordings import Measured
from rovsim.application.pipeline.replays import measure_growth, replay_models
from rovsim.application.sections import SimulationSettings
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.scores import score_all
from rovsim.reporting.report_data import ReportData


def compare(data: Measured, models: Sequence[Model], settings: SimulationSettings) -> ReportData:
    """Replays, scores and findings of all models, forces of the last."""
    motions = list(data.motions.values())
    replays = replay_models(models, motions, settings)
    grown = measure_growth(motions, replays)
    where = find_error_conditions([m for m in models if not m.inert], motions, settings)
    forces = {
        m.run.id: balance_run(models[-1], m, settings) for m in counted(motions, "balancing forces")
    }
    return ReportData(
        motions=data.motions,
        replays=replays,
        budgets=forces,
        quality=data.quality,
        comparison=score_all(motions, replays),
        growth=grown,
        where=where,
    )
