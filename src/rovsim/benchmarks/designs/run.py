"""A case from the run before to its result."""

from pathlib import Path

from rovsim.benchmarks.blind.case import Range
from rovsim.benchmarks.designs.designed_case import DesignedCase, design_case
from rovsim.benchmarks.designs.flight import fly
from rovsim.results.design_benchmark import FlownCase, HiddenEffect, Outcome


def run_case(case: str, seeds: Range, folder: Path) -> FlownCase:
    """Hide, plan, fly, fit: what was promised, and what came of it; its files go to `folder`."""
    designed = design_case(case, seeds, folder)
    result = _describe(case, designed, fly(designed, "designed", designed.plan.best.flight))
    if designed.best_usual is None:
        return result
    return result.model_copy(update={"usual": fly(designed, "usual", designed.best_usual)})


def _describe(case: str, designed: DesignedCase, outcome: Outcome) -> FlownCase:
    """The result without the usual manoeuvre's flight."""
    experiment, best = designed.experiment, designed.best_usual
    hidden = [HiddenEffect(effect=e.effect, parameters=e.values) for e in designed.tank.effects]
    ratios = [usual.designed_is_better for usual in experiment.baselines.values()]
    return FlownCase(
        case=case,
        seconds=designed.seconds,
        cpu_seconds=designed.cpu_seconds,
        manoeuvre=designed.plan.best.flight.name,
        hidden=tuple(hidden),
        promised=experiment.expects,
        best_usual=best.name if best else None,
        expected_ratio=min((ratio for ratio in ratios if ratio), default=None),
        designed=outcome,
    )
