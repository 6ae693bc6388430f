"""How far a model is from the measurement: one definition of each number, used everywhere."""

from dataclasses import dataclass
from typing import Any, Iterable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.rotations import conjugate, log, multiply
from rovsim.measurement.recording.quality import EXCITED
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.prediction import OPEN_LOOP, Prediction, Replay
from rovsim.simulation.windows import find_windows

COMPARISON = "rovsim.comparison/1"


@dataclass(frozen=True, eq=False)
class Errors:
    """Model minus measurement at the samples both have.

    `nu` (n, 6), `nu_dot` (m, 6), `position` (n,) m, `attitude` (n,) rad.
    """

    nu: Array
    nu_dot: Array
    position: Array
    attitude: Array


def errors(motion: Motion, prediction: Prediction) -> Errors:
    """Errors of one prediction at usable samples; infinite where it diverged."""
    both = motion.usable & ~np.isnan(prediction.nu).any(axis=1)
    moved = both & ~np.isnan(prediction.nu_dot).any(axis=1) & np.isfinite(motion.nu_dot).all(axis=1)
    with np.errstate(invalid="ignore"):
        turn = log(multiply(conjugate(motion.eta[both, 3:]), prediction.eta[both, 3:]))
    return Errors(
        prediction.nu[both] - motion.nu[both],
        prediction.nu_dot[moved] - motion.nu_dot[moved],
        np.linalg.norm(prediction.eta[both, :3] - motion.eta[both, :3], axis=1),
        np.linalg.norm(turn, axis=1),
    )


def pooled(parts: Sequence[Errors]) -> Errors:
    """Errors of several runs as one set of samples."""
    names = ("nu", "nu_dot", "position", "attitude")
    return Errors(*(np.concatenate([getattr(p, name) for p in parts]) for name in names))


def rms(x: Array) -> Array:
    """Root mean square over the first axis; NaN where there is nothing."""
    return np.sqrt(np.mean(np.square(x), axis=0)) if len(x) else np.full(x.shape[1:], np.nan)


def mean_absolute(x: Array) -> Array:
    """Mean absolute value over the first axis; NaN where there is nothing."""
    return np.mean(np.abs(x), axis=0) if len(x) else np.full(x.shape[1:], np.nan)


def metrics(found: Errors) -> dict[str, Any]:
    """The metrics of contract section 3; None where the model left the finite numbers."""
    return {
        "acceleration_rmse": by_axis(rms(found.nu_dot)),
        "velocity_mae": by_axis(mean_absolute(found.nu)),
        "velocity_rmse": by_axis(rms(found.nu)),
        "position_rmse_m": number(rms(found.position)),
        "attitude_rmse_rad": number(rms(found.attitude)),
    }


def number(value: Any) -> float | None:
    """A finite number, else None (JSON has no NaN)."""
    return float(value) if np.isfinite(value) else None


def by_axis(values: Array) -> dict[str, float | None]:
    """Six values named surge ... yaw."""
    return {axis: number(v) for axis, v in zip(AXES, values, strict=True)}


def score(motion: Motion, replay: Replay) -> dict[str, Any]:
    """All metrics of one model on one run."""
    found = {name: metrics(errors(motion, p)) for name, p in replay.horizons.items()}
    opened = found.pop(OPEN_LOOP)
    return {
        "model": replay.model,
        "run": motion.run.id,
        "split": motion.run.split,
        "control": motion.run.control,
        "open_loop": opened,
        "windows": found,
    }


def comparison(scores: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """`comparison.json` from the scores of models and runs."""
    models: dict[str, dict] = {}
    for one in scores:
        runs = models.setdefault(one["model"], {"runs": {}})["runs"]
        runs[one["run"]] = {k: one[k] for k in ("split", "control", "open_loop", "windows")}
    return {"schema": COMPARISON, "models": models}


def normalised(motions: Sequence[Motion], velocity_rmse: Array) -> float | None:
    """Velocity RMSE (6,) over the standard deviation of the measured velocity, mean over axes.

    Only axes that were excited count: an axis nobody moved cannot be judged.
    """
    nu = np.concatenate([m.nu[m.usable] for m in motions])
    spread = np.std(nu, axis=0)
    moved = spread > EXCITED
    return number(np.mean(velocity_rmse[moved] / spread[moved])) if moved.any() else None


def growth(
    motions: Sequence[Motion], replays: Sequence[Replay], horizon: str = "5"
) -> dict[str, Any]:
    """Velocity RMSE against time since the anchor, from the windows of one horizon, test runs."""
    ages, found = [], []
    for motion, replay in zip(motions, replays, strict=True):
        if motion.run.split == "test" and horizon in replay.horizons:
            prediction = replay.horizons[horizon]
            known = motion.usable & ~np.isnan(prediction.nu).any(axis=1)
            ages.append(_age(motion, prediction, float(horizon))[known])
            found.append((prediction.nu - motion.nu)[known])
    age, error = np.concatenate([*ages, np.empty(0)]), np.concatenate([*found, np.empty((0, 6))])
    edges = np.linspace(0.0, float(horizon), 26)
    bins = np.digitize(age, edges)
    kept = [b for b in range(1, len(edges)) if np.any(bins == b)]
    rows = np.array([rms(error[bins == b]) for b in kept]).reshape(-1, 6)
    return {
        "horizon_s": [float(edges[b]) for b in kept],
        "velocity_rmse": {
            axis: [number(x) for x in row] for axis, row in zip(AXES, rows.T, strict=True)
        },
    }


def _age(motion: Motion, prediction: Prediction, horizon: float) -> Array:
    """Time since the anchor of the window each sample belongs to, s."""
    age = np.full(len(motion.time), np.nan)
    for a, b in find_windows(motion, horizon):
        at = slice(a, b) if motion.binned else slice(a + 1, b + 1)
        age[at] = motion.time[at] - motion.time[a]
    return age
