"""Models beside the measurement: replayed with the logged commands, and scored."""

from typing import Mapping, Sequence

from rovsim.application.sections import SimulationSettings
from rovsim.core.progress import counted
from rovsim.dynamics.model import Model
from rovsim.evaluation.ladder import score_step
from rovsim.evaluation.scores import trace_growth
from rovsim.measurement.signals.motion import Motion
from rovsim.results.growth import Growth
from rovsim.results.ladder import Step
from rovsim.simulation.prediction import Replay
from rovsim.simulation.replay import replay

Replays = Mapping[str, Mapping[str, Replay]]  # by model and run


def replay_models(
    models: Sequence[Model], motions: Sequence[Motion], settings: SimulationSettings
) -> dict[str, dict[str, Replay]]:
    """Every run replayed with every model."""
    replays: dict[str, dict[str, Replay]] = {model.name: {} for model in models}
    pairs = [(model, motion) for model in models for motion in motions]
    for model, motion in counted(pairs, "replaying"):
        replays[model.name][motion.run.id] = replay(
            model, motion, settings.signals, settings.replay
        )
    return replays


def measure_growth(motions: Sequence[Motion], replays: Replays) -> Growth:
    """How the error grows with time, by model."""
    curves = {name: trace_growth(motions, list(runs.values())) for name, runs in replays.items()}
    return Growth(models=curves)


def climb(motions: Sequence[Motion], replays: Replays) -> list[Step]:
    """A step of the ladder for each model, on the test runs."""
    return [score_step(name, motions, list(runs.values())) for name, runs in replays.items()]
