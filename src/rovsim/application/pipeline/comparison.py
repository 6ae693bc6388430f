"""Compare models: replays, scores, conditions of their errors, and forces."""

from typing import Sequence

import numpy as np

from rovsim.application.pipeline.bands import bands_when_asked, cover_test_runs
from rovsim.application.pipeline.measured_campaign import MeasuredCampaign
from rovsim.application.pipeline.replays import replay_and_score, replay_when_asked
from rovsim.core.bounded_cache import Remade
from rovsim.core.horizons import OPEN_LOOP, STANDARD_HORIZON
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.entries import list_conditions
from rovsim.evaluation.error_conditions.search import ConditionSearch
from rovsim.evaluation.force_budget import balance_forces
from rovsim.evaluation.score_collector import ScoreCollector
from rovsim.reporting.report_data import ReportData
from rovsim.results.comparison import Comparison
from rovsim.results.force_budget import BudgetTotals
from rovsim.simulation.settings import SimulationSettings

MAX_DRAWN_RUNS = 12  # a report of fifty figures can still be read


def compare(
    data: MeasuredCampaign, models: Sequence[Model], settings: SimulationSettings
) -> ReportData:
    """Replay and score all models on all runs; balance the forces of the last model.

    Runs are taken once, one after the other, so that memory does not grow with their number.
    """
    scores = ScoreCollector((model.name for model in models), settings.replay.longest)
    searches = _searches(data, models, settings)
    replays = replay_when_asked(models, data.motions, settings)
    budgets = Remade(
        data.motions, lambda run: balance_forces(models[-1], data.motions[run], settings)
    )
    totals = {}
    for run in counted(list(data.motions), "comparing"):
        motion = data.motions[run]
        for model in models:
            replay = replay_and_score(scores, model, motion, settings, STANDARD_HORIZON, OPEN_LOOP)
            replays[model.name].keep(run, replay)
        for search in searches:
            search.add_run(motion)
        totals[run] = budgets[run].totals
    return ReportData(
        motions=data.motions,
        replays=replays,
        bands=bands_when_asked(models, data.motions, settings),
        band_coverage=cover_test_runs(models, data, settings),
        budgets=budgets,
        quality=data.quality,
        comparison=scores.comparison,
        growth=scores.growth,
        steps=tuple(scores.steps),
        budget_totals=BudgetTotals(runs=totals),
        where=list_conditions([search.result for search in searches]),
        drawn=_choose_drawn(scores.comparison, models[-1].name, list(data.motions)),
    )


def _choose_drawn(comparison: Comparison, model: str, runs: Sequence[str]) -> tuple[str, ...]:
    """Choose runs to draw: all, or the `MAX_DRAWN_RUNS` with the largest errors, in their order.

    Args:
        comparison: errors of all models.
        model: whose errors count, relative to the median over runs, averaged over axes.
        runs: to choose from.
    """
    if len(runs) <= MAX_DRAWN_RUNS:
        return tuple(runs)
    errors = comparison.models[model].runs
    rmse = np.array([errors[run].windows[STANDARD_HORIZON].velocity_rmse.array() for run in runs])
    rmse = np.nan_to_num(rmse[:, np.isfinite(rmse).any(axis=0)], nan=np.inf)  # diverged: the worst
    worst = np.argsort(-np.mean(rmse / np.median(rmse, axis=0), axis=1), kind="stable")
    return tuple(runs[k] for k in sorted(worst[:MAX_DRAWN_RUNS].tolist()))


def _searches(
    data: MeasuredCampaign, models: Sequence[Model], settings: SimulationSettings
) -> list[ConditionSearch]:
    splits = [data.quality[run].split for run in data.motions]
    dynamic = [model for model in models if not model.inert]
    return [ConditionSearch(m, splits, settings) for m in dynamic]
