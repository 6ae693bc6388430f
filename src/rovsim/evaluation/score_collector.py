"""All errors of several models, collected run by run: only sums of a run are kept."""

from typing import Iterable, Mapping

from rovsim.core.horizons import OPEN_LOOP, STANDARD_HORIZON, name_horizon
from rovsim.evaluation.error_metrics import compute_metrics, subtract
from rovsim.evaluation.growth import GrowthScore
from rovsim.evaluation.ladder import StepScore
from rovsim.measurement.signals.motion import Motion
from rovsim.results.comparison import Comparison, Metrics, ModelErrors, RunErrors
from rovsim.results.growth import Growth
from rovsim.results.ladder import LadderStep
from rovsim.simulation.prediction import Prediction, Replay


class ScoreCollector:
    """Collects errors of models by run, their growth, and the models' steps of the ladder.

    Args:
        models: their names.
        longest: horizon of the replays, s, in whose windows the growth of errors is measured.
    """

    def __init__(self, models: Iterable[str], longest: float) -> None:
        self._models = {name: _ModelScores(name, longest) for name in models}

    @staticmethod
    def of(
        motions: Iterable[Motion], replays: Mapping[str, Mapping[str, Replay]]
    ) -> "ScoreCollector":
        """Collect replays, given by model and run."""
        scored = ScoreCollector(replays, _find_longest(replays))
        for motion in motions:
            for runs in replays.values():
                scored.add_replay(motion, runs[motion.run.id])
        return scored

    def add_replay(self, motion: Motion, replay: Replay) -> None:
        """Add the replay of a run by one of the models."""
        self.add_predictions(motion, replay.model, replay.horizons.items())

    def add_predictions(
        self, motion: Motion, model: str, horizons: Iterable[tuple[str, Prediction]]
    ) -> None:
        """Add the predictions of a model for a run, with the names of their horizons.

        They may come from a generator, so that only one of them is in memory at a time.
        """
        self._models[model].add(motion, horizons)

    @property
    def comparison(self) -> Comparison:
        """Errors by model and run, as `comparison.json`."""
        models = {name: ModelErrors(runs=s.runs) for name, s in self._models.items()}
        return Comparison(models=models)

    @property
    def growth(self) -> Growth:
        """Growth of the error of each model, as `growth.json`."""
        return Growth(models={name: s.growth.curve for name, s in self._models.items()})

    @property
    def steps(self) -> list[LadderStep]:
        """The step of each model on the ladder, on the test runs."""
        return [s.step.step for s in self._models.values()]


def score_replay(motion: Motion, replay: Replay) -> RunErrors:
    """Compute all metrics of one model on one run."""
    run_score = _ModelScores(replay.model, replay.longest)
    run_score.add(motion, replay.horizons.items())
    return run_score.runs[motion.run.id]


def _find_longest(replays: Mapping[str, Mapping[str, Replay]]) -> float:
    """The longest horizon of all replays, which are of one configuration; 0 without replays."""
    return next((r.longest for runs in replays.values() for r in runs.values()), 0.0)


class _ModelScores:
    """Collects the errors of one model; `longest` s is its longest horizon."""

    def __init__(self, model: str, longest: float) -> None:
        self.runs: dict[str, RunErrors] = {}
        self.growth, self.step = GrowthScore(longest), StepScore(model)

    def add(self, motion: Motion, horizons: Iterable[tuple[str, Prediction]]) -> None:
        summaries = {}
        for name, prediction in horizons:
            summaries[name] = self._summarize(motion, name, prediction)
            del prediction  # frees its memory before the next one is made
        run = motion.run
        self.runs[run.id] = RunErrors(
            split=run.split,
            control=run.control,
            open_loop=summaries.pop(OPEN_LOOP),
            windows=summaries,
        )

    def _summarize(self, motion: Motion, horizon: str, prediction: Prediction) -> Metrics:
        errors = subtract(motion, prediction)
        if horizon == STANDARD_HORIZON:
            self.step.add(motion, errors)
        if horizon == name_horizon(self.growth.horizon):
            self.growth.add(motion, prediction)
        return compute_metrics(errors)
