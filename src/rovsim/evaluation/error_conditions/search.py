"""Search the runs of a campaign for conditions in which a model fails."""

from dataclasses import dataclass
from typing import Collection

from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.conditions import Blocks, average_blocks, join_blocks
from rovsim.evaluation.error_conditions.findings import ErrorExplanation, explain_errors
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.samples import Samples, sample_run
from rovsim.simulation.settings import SimulationSettings


@dataclass(frozen=True, eq=False)
class SearchedModel:
    """What was found for one model.

    Attributes:
        model: its name.
        split: of the runs that were searched, "train" or "test".
        runs: ids of these runs.
        explanation: errors by axis and condition, and the findings.
    """

    model: str
    split: str
    runs: tuple[str, ...]
    explanation: ErrorExplanation


def choose_split(model: Model, splits: Collection[str]) -> str:
    """Choose the split on whose runs a model is searched.

    These are the train runs, so that the test runs stay unseen for those who decide by the findings
    what to add. For a model with a learned residual, which was fitted to the train runs, these are
    the test runs. If the campaign lacks that split, the other one is chosen.

    Args:
        model: the model.
        splits: those that the campaign has.
    """
    split = "test" if model.residual is not None else "train"
    return split if split in splits else next(iter(splits))


class ConditionSearch:
    """Searches for conditions in which a model fails, taking in one run after the other.

    Args:
        model: the model.
        splits: those of the runs that will be taken in.
        settings: of the filter of the measurement, and of how commands are held.
    """

    def __init__(self, model: Model, splits: Collection[str], settings: SimulationSettings) -> None:
        self._model, self._settings = model, settings
        self.split = choose_split(model, splits)
        self._runs: list[str] = []
        self._parts: list[Blocks] = []

    def add_run(self, motion: Motion) -> None:
        """Take in a run; ignore a run of the other split."""
        if motion.run.split == self.split:
            self.add_samples(motion, sample_run(self._model, motion, self._settings))

    def add_samples(self, motion: Motion, samples: Samples) -> None:
        """Take in a run that was sampled already; ignore a run of the other split."""
        if motion.run.split != self.split:
            return
        self._runs.append(motion.run.id)
        if len(samples.index) > 1:
            self._parts.append(average_blocks(motion, samples))

    @property
    def result(self) -> SearchedModel:
        """What the error on the runs so far varies with."""
        parts = self._parts
        if not parts:
            explanation = ErrorExplanation.nothing()
        else:
            explanation = explain_errors(join_blocks(parts), inertia=self._model.M)
        return SearchedModel(self._model.name, self.split, tuple(self._runs), explanation)


def search_runs(model: Model, runs: Runs, settings: SimulationSettings) -> SearchedModel:
    """Search the runs of a campaign for conditions in which a model fails.

    Args:
        model: the model.
        runs: of the campaign.
        settings: of the filter of the measurement, and of how commands are held.
    """
    search = ConditionSearch(model, set(runs.splits.values()), settings)
    for name in runs.of(search.split):
        search.add_run(runs.motions[name])
    return search.result
