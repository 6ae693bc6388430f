"""The ladder: the error falling, step by step, on runs that no step was fitted to."""

from typing import Sequence

from rovsim.evaluation.scores import normalize, pool, rms, subtract, summarize
from rovsim.measurement.signals.motion import Motion
from rovsim.results.ladder import Step
from rovsim.simulation.prediction import Replay


def score_step(
    name: str, motions: Sequence[Motion], replays: Sequence[Replay], split: str = "test"
) -> Step:
    """A model's error in 2 s windows, all runs of the split pooled; None where there is none."""
    pairs = [(m, r) for m, r in zip(motions, replays, strict=True) if m.run.split == split]
    if not pairs:
        return Step(model=name)
    errors = pool([subtract(m, r.horizons["2"]) for m, r in pairs])
    metrics = summarize(errors)
    return Step(
        model=name,
        split=split,
        acceleration_rmse=metrics.acceleration_rmse,
        velocity_mae=metrics.velocity_mae,
        windows_2s=normalize([m for m, _ in pairs], rms(errors.nu)),
    )
