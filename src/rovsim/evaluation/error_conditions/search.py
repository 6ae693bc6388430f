"""Search the runs of a campaign for conditions in which a model fails."""

from dataclasses import dataclass
from typing import Sequence

from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.conditions import average_blocks, join_blocks
from rovsim.evaluation.error_conditions.findings import Explanation, explain
from rovsim.learning.pairs import Samples, sample_run
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.settings import ReplaySettings


@dataclass(frozen=True, eq=False)
class SearchedModel:
    """What was found for one model, on the runs it was judged on, all of one split."""

    model: str
    split: str
    runs: tuple[str, ...]
    explanation: Explanation


def choose_runs(model: Model, motions: Sequence[Motion]) -> list[Motion]:
    """The runs a model is searched on.

    Train runs: whoever decides by the findings what to add has not looked at the test runs yet.
    Test runs for a model with a trained residual, which knows the train runs by heart. Where the
    campaign has only the other split, that one.
    """
    split = "test" if model.residual is not None else "train"
    return [m for m in motions if m.run.split == split] or list(motions)


def search_conditions(
    model: Model, motions: Sequence[Motion], signals: SignalSettings, settings: ReplaySettings
) -> SearchedModel:
    """Search the runs of a campaign for conditions in which the model fails."""
    runs = choose_runs(model, motions)
    found: list[Samples] = [sample_run(model, m, signals, settings) for m in runs]
    parts = [average_blocks(m, s) for m, s in zip(runs, found, strict=True) if len(s.index) > 1]
    explanation = explain(join_blocks(parts)) if parts else Explanation.nothing()
    names = tuple(m.run.id for m in runs)
    return SearchedModel(model.name, runs[0].run.split, names, explanation)
