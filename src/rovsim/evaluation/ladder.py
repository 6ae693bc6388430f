"""The ladder: the error falling, step by step, on runs that no step was fitted to."""

from typing import Any, Iterable, Sequence

import numpy as np

from rovsim.evaluation.scores import by_axis, errors, metrics, normalised, pooled, rms
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.prediction import Replay

SCHEMA = "rovsim.ladder/1"
EFFECTS, FLOOR = "effects", "noise_floor"


def step(
    name: str, motions: Sequence[Motion], replays: Sequence[Replay], split: str = "test"
) -> dict[str, Any]:
    """A model's error in 2 s windows, all runs of the split pooled; None where there is none."""
    pairs = [(m, r) for m, r in zip(motions, replays, strict=True) if m.run.split == split]
    if not pairs:
        return _without_runs(name, None)
    found = pooled([errors(m, r.horizons["2"]) for m, r in pairs])
    numbers = metrics(found)
    return {
        "model": name,
        "split": split,
        "acceleration_rmse": numbers["acceleration_rmse"],
        "velocity_mae": numbers["velocity_mae"],
        "windows_2s": normalised([m for m, _ in pairs], rms(found.nu)),
    }


def floor_step(error: float | None) -> dict[str, Any]:
    """The noise floor: a bound, known only for the velocity in 2 s windows."""
    return _without_runs(FLOOR, error)


def _without_runs(name: str, error: float | None) -> dict[str, Any]:
    unknown = by_axis(np.full(6, np.nan))
    return {
        "model": name, "split": "test", "acceleration_rmse": unknown, "velocity_mae": unknown,
        "windows_2s": error,
    }  # fmt: skip


def ladder(steps: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """`ladder.json` of these steps."""
    return {"schema": SCHEMA, "steps": list(steps)}


def with_diagnosis(
    models: Sequence[dict[str, Any]], diagnosed: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """`ladder.json` of models and a diagnosis: its effects one by one, its noise floor last.

    The effects stand where the model that has all of them would.
    """
    added = [s for s in diagnosed if s["model"].startswith("+")]
    floor = [s for s in diagnosed if s["model"] == FLOOR]
    found = [s for m in models for s in (added if m["model"] == EFFECTS else [m])]
    return ladder([*found, *floor])
