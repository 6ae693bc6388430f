"""All that is said of some models' errors, taken in run by run: nothing of a run is held."""

from typing import Iterable, Mapping

from rovsim.core.horizons import HORIZON, OPEN_LOOP, name_horizon
from rovsim.evaluation.growth import GrowthScore
from rovsim.evaluation.ladder import StepScore
from rovsim.evaluation.scores import subtract, summarize
from rovsim.measurement.signals.motion import Motion
from rovsim.results.comparison import Comparison, Metrics, ModelErrors, RunErrors
from rovsim.results.growth import Growth
from rovsim.results.ladder import Step
from rovsim.simulation.prediction import Prediction, Replay


class Scored:
    """Errors of models by run, how they grow, and the models' steps of the ladder.

    `longest` s of the horizons of their replays: in these windows the growth is seen.
    """

    def __init__(self, models: Iterable[str], longest: float) -> None:
        self._models = {name: _Score(name, longest) for name in models}

    @staticmethod
    def of(motions: Iterable[Motion], replays: Mapping[str, Mapping[str, Replay]]) -> "Scored":
        """Of replays by model and run."""
        found = Scored(replays, _find_longest(replays))
        for motion in motions:
            for runs in replays.values():
                found.add(motion, runs[motion.run.id])
        return found

    def add(self, motion: Motion, replay: Replay) -> None:
        """Take in the replay of a run by one of the models."""
        self.take(motion, replay.model, replay.horizons.items())

    def take(self, motion: Motion, model: str, horizons: Iterable[tuple[str, Prediction]]) -> None:
        """Take in what a model predicts of a run; of a long one each horizon is large."""
        self._models[model].add(motion, horizons)

    @property
    def comparison(self) -> Comparison:
        """`comparison.json`."""
        models = {name: ModelErrors(runs=one.runs) for name, one in self._models.items()}
        return Comparison(models=models)

    @property
    def growth(self) -> Growth:
        """`growth.json`."""
        return Growth(models={name: one.growth.curve for name, one in self._models.items()})

    @property
    def steps(self) -> list[Step]:
        """A step of the ladder for each model, on the test runs."""
        return [one.step.step for one in self._models.values()]


def score(motion: Motion, replay: Replay) -> RunErrors:
    """All metrics of one model on one run."""
    one = _Score(replay.model, replay.longest)
    one.add(motion, replay.horizons.items())
    return one.runs[motion.run.id]


def _find_longest(replays: Mapping[str, Mapping[str, Replay]]) -> float:
    """Of all alike: they are of one configuration."""
    return next((one.longest for runs in replays.values() for one in runs.values()), 0.0)


class _Score:
    def __init__(self, model: str, longest: float) -> None:
        self.runs: dict[str, RunErrors] = {}
        self.growth, self.step = GrowthScore(longest), StepScore(model)

    def add(self, motion: Motion, horizons: Iterable[tuple[str, Prediction]]) -> None:
        found = {}
        for name, prediction in horizons:
            found[name] = self._summarize(motion, name, prediction)
            del prediction  # while the next one is made
        run = motion.run
        self.runs[run.id] = RunErrors(
            split=run.split, control=run.control, open_loop=found.pop(OPEN_LOOP), windows=found
        )

    def _summarize(self, motion: Motion, horizon: str, prediction: Prediction) -> Metrics:
        errors = subtract(motion, prediction)
        if horizon == HORIZON:
            self.step.add(motion, errors)
        if horizon == name_horizon(self.growth.horizon):
            self.growth.add(motion, prediction)
        return summarize(errors)
