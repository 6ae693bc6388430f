"""A cache: replays and errors of models on the runs of a campaign, each computed once."""

from dataclasses import dataclass, field

from numpy import ndarray as Array

from rovsim.core.bounded_cache import Recent
from rovsim.core.horizons import OPEN_LOOP, STANDARD_WINDOW, name_horizon
from rovsim.dynamics.model import Model
from rovsim.evaluation.error_conditions.search import SearchedModel, search_runs
from rovsim.evaluation.error_metrics import compute_metrics, subtract
from rovsim.evaluation.ladder import score_step
from rovsim.measurement.runs import Runs
from rovsim.results.comparison import Metrics
from rovsim.results.ladder import LadderStep
from rovsim.simulation.bands import Band, predict_band
from rovsim.simulation.measured_states import drive_as_measured
from rovsim.simulation.prediction import Prediction, Replay
from rovsim.simulation.replay import find_spans, replay
from rovsim.simulation.settings import SimulationSettings


@dataclass(eq=False)
class KeptReplays:
    """Replays and errors of models on some runs, computed when first asked for.

    Attributes:
        runs: what was measured.
        settings: of the replays.
    """

    runs: Runs
    settings: SimulationSettings
    _replays: Recent[Replay] = field(default_factory=Recent)
    _bands: Recent[Band | None] = field(default_factory=Recent)
    _steps: dict[Model, LadderStep] = field(default_factory=dict)
    _searched: dict[Model, SearchedModel] = field(default_factory=dict)
    _thrusts: Recent[Array] = field(default_factory=Recent)

    def replayed(self, model: Model, run: str, horizon: float | None) -> Replay:
        """Return the replay of a run, restarted every `horizon` s, or open loop (None)."""
        key = (model, run, horizon)
        spans = () if horizon is None else (horizon,)
        settings = self.settings.only(*spans)
        return self._replays.get(
            key,
            lambda: replay(model, self.runs.motions[run], settings, not spans),
        )

    def prediction(self, model: Model, run: str, horizon: float | None) -> Prediction:
        """Return what a model predicts when restarted every `horizon` s, or open loop (None)."""
        name = OPEN_LOOP if horizon is None else name_horizon(horizon)
        return self.replayed(model, run, horizon).horizons[name]

    def band(self, model: Model, run: str, horizon: float | None) -> Band | None:
        """Return the probability band of a prediction; None for a model without one."""
        spans = () if horizon is None else (horizon,)
        motion, settings = self.runs.motions[run], self.settings.only(*spans)
        (windows,) = find_spans(motion, settings.replay, open_loop=not spans).values()
        return self._bands.get(
            (model, run, horizon),
            lambda: predict_band(model, motion, windows, settings) if windows else None,
        )

    def thrust(self, model: Model, run: str) -> Array:
        """Return the thrust (n, 6) that commands cause at samples or bins of a run, N and N m."""
        motion, settings = self.runs.motions[run], self.settings.replay
        return self._thrusts.get(
            (model, run), lambda: drive_as_measured(model, motion, settings).wrench
        )

    def metrics(self, model: Model, run: str, horizon: float | None) -> Metrics:
        """Return the errors on one run, with the numbers of comparison.json."""
        return compute_metrics(
            subtract(self.runs.motions[run], self.prediction(model, run, horizon))
        )

    def run_error(self, model: Model, run: str) -> float | None:
        """Return the 2 s error (`windows_2s`) on one run alone; None if it has none."""
        motion = self.runs.motions[run]
        replayed = self.replayed(model, run, STANDARD_WINDOW)
        return score_step(model.name, [(motion, replayed)], motion.run.split).windows_2s

    def step(self, model: Model) -> LadderStep:
        """Return the ladder's step of a model, its errors on the test runs; this opens these."""
        if model not in self._steps:
            tests = self.runs.of("test")
            pairs = (
                (self.runs.motions[r], self.replayed(model, r, STANDARD_WINDOW)) for r in tests
            )
            self._steps[model] = score_step(model.name, pairs)
        return self._steps[model]

    def searched(self, model: Model) -> SearchedModel:
        """Return the search for conditions under which a model fails."""
        if model not in self._searched:
            self._searched[model] = search_runs(model, self.runs, self.settings)
        return self._searched[model]
