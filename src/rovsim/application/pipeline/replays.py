"""Replay models with the logged commands, and score them against the measurement."""

from typing import Iterator, Mapping, Sequence

from rovsim.core.bounded_cache import Recent, Remade
from rovsim.core.horizons import STANDARD_WINDOW
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.score_collector import ScoreCollector
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.prediction import Prediction, Replay
from rovsim.simulation.replay import by_horizon, replay
from rovsim.simulation.settings import SimulationSettings

Replays = Mapping[str, Mapping[str, Replay]]  # by model and run


def replay_when_asked(
    models: Sequence[Model], motions: Mapping[str, Motion], settings: SimulationSettings
) -> dict[str, Remade[Replay]]:
    """Prepare replays as figures show them, in windows of 2 s and open loop.

    A replay is computed when it is asked for; those asked for last are kept, for all models
    together.

    Returns:
        Replays by model and run.
    """
    window_settings, recent = settings.only(STANDARD_WINDOW), Recent[Replay]()

    def by(model: Model) -> Remade[Replay]:
        return Remade(
            motions, lambda run: replay(model, motions[run], window_settings), recent=recent
        )

    return {model.name: by(model) for model in models}


def score_models(
    models: Sequence[Model], motions: Mapping[str, Motion], settings: SimulationSettings
) -> ScoreCollector:
    """Replay every run with every model, and score it."""
    scores = ScoreCollector((model.name for model in models), settings.replay.longest)
    for run in counted(list(motions), "replaying"):
        for model in models:
            replay_and_score(scores, model, motions[run], settings)
    return scores


def replay_and_score(
    scores: ScoreCollector, model: Model, motion: Motion, settings: SimulationSettings, *kept: str
) -> Replay:
    """Replay a run horizon by horizon, and add each prediction to the scores.

    Args:
        scores: so far; changed in place.
        model: that is replayed.
        motion: the run as measured.
        settings: how it is replayed.
        kept: names of horizons to return; the others are dropped to save memory.
    """
    kept_replay = Replay(model.name, motion.run, motion.time, {})

    def horizons() -> Iterator[tuple[str, Prediction]]:
        for name, prediction in by_horizon(model, motion, settings):
            if name in kept:
                kept_replay.horizons[name] = prediction
            yield name, prediction
            del prediction  # while the next one is made

    scores.add_predictions(motion, model.name, horizons())
    return kept_replay
