"""Search the runs of a campaign for conditions in which a model fails."""

from dataclasses import dataclass
from typing import Collection

from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.conditions import Blocks, average_blocks, join_blocks
from rovsim.evaluation.error_conditions.findings import ErrorExplanation, explain
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.samples import Samples, sample_run
from rovsim.simulation.settings import SimulationSettings


@dataclass(frozen=True, eq=False)
class SearchedModel:
    """What was found for one model, on the runs it was judged on, all of one split."""

    model: str
    split: str
    runs: tuple[str, ...]
    explanation: ErrorExplanation


def choose_split(model: Model, splits: Collection[str]) -> str:
    """The split a model is searched on, of those that there are.

    Train runs: whoever decides by the findings what to add has not looked at the test runs yet.
    Test runs for a model with a trained residual, which knows the train runs by heart. Where the
    campaign has only the other split, that one.
    """
    split = "test" if model.residual is not None else "train"
    return split if split in splits else next(iter(splits))


class ConditionSearch:
    """A search for conditions in which a model fails; takes in one run after the other.

    Args:
        model: the model.
        splits: those of the runs that will come.
        how: measurements were cleaned, and commands are held.
    """

    def __init__(self, model: Model, splits: Collection[str], how: SimulationSettings) -> None:
        self._model, self._how = model, how
        self.split = choose_split(model, splits)
        self._runs: list[str] = []
        self._parts: list[Blocks] = []

    def add(self, motion: Motion) -> None:
        """Take in a run; one of the other split is passed by."""
        if motion.run.split == self.split:
            self.take(motion, sample_run(self._model, motion, self._how))

    def take(self, motion: Motion, samples: Samples) -> None:
        """Take in a run of which there are samples; one of the other split is passed by."""
        if motion.run.split != self.split:
            return
        self._runs.append(motion.run.id)
        if len(samples.index) > 1:
            self._parts.append(average_blocks(motion, samples))

    @property
    def found(self) -> SearchedModel:
        """What the error varies with."""
        parts = self._parts
        if not parts:
            explanation = ErrorExplanation.nothing()
        else:
            explanation = explain(join_blocks(parts), inertia=self._model.M)
        return SearchedModel(self._model.name, self.split, tuple(self._runs), explanation)


def search_runs(model: Model, runs: Runs, how: SimulationSettings) -> SearchedModel:
    """Search the runs of a campaign, one after the other, for conditions in which it fails."""
    search = ConditionSearch(model, set(runs.splits.values()), how)
    for name in runs.of(search.split):
        search.add(runs.motions[name])
    return search.found
