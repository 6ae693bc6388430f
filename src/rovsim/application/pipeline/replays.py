"""Models beside the measurement: replayed with the logged commands, and scored."""

from typing import Iterator, Mapping, Sequence

from rovsim.core.bounded_cache import Recent, Remade
from rovsim.core.horizons import WINDOW
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.scored import Scored
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.prediction import Prediction, Replay
from rovsim.simulation.replay import by_horizon, replay
from rovsim.simulation.settings import SimulationSettings

Replays = Mapping[str, Mapping[str, Replay]]  # by model and run


def replay_when_asked(
    models: Sequence[Model], motions: Mapping[str, Motion], settings: SimulationSettings
) -> dict[str, Remade[Replay]]:
    """Replays of every run by every model, in windows of 2 s and open loop, as figures show them.

    Made when they are asked for; all models share what is kept of them.
    """
    how, recent = settings.only(WINDOW), Recent[Replay]()

    def by(model: Model) -> Remade[Replay]:
        return Remade(motions, lambda run: replay(model, motions[run], how), recent=recent)

    return {model.name: by(model) for model in models}


def score_models(
    models: Sequence[Model], motions: Mapping[str, Motion], settings: SimulationSettings
) -> Scored:
    """Every run replayed with every model, and scored."""
    scored = Scored((model.name for model in models), settings.replay.longest)
    for run in counted(list(motions), "replaying"):
        for model in models:
            score_run(scored, model, motions[run], settings)
    return scored


def score_run(
    scored: Scored, model: Model, motion: Motion, settings: SimulationSettings, *kept: str
) -> Replay:
    """Replay a run and take it in, horizon by horizon; what comes back are those to be `kept`."""
    found = Replay(model.name, motion.run, motion.time, {})

    def horizons() -> Iterator[tuple[str, Prediction]]:
        for name, prediction in by_horizon(model, motion, settings):
            if name in kept:
                found.horizons[name] = prediction
            yield name, prediction
            del prediction  # while the next one is made

    scored.take(motion, model.name, horizons())
    return found
