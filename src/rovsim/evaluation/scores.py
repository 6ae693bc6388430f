"""How far a model is from the measurement: one definition of each number, used everywhere."""

from dataclasses import dataclass
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.rotations import conjugate, log, multiply
from rovsim.measurement.quality import EXCITED
from rovsim.measurement.signals.measured import Measured, blank
from rovsim.measurement.signals.motion import Motion
from rovsim.results.base import ByAxis, or_none
from rovsim.results.comparison import OPEN_LOOP, Comparison, Metrics, ModelErrors, RunErrors
from rovsim.results.growth import Curve
from rovsim.simulation.prediction import Prediction, Replay
from rovsim.simulation.windows import find_windows


@dataclass(frozen=True, eq=False)
class Errors:
    """Model minus measurement at the samples both have.

    `nu` (n, 6), `nu_dot` (m, 6), `position` (n,) m, `attitude` (n,) rad.
    """

    nu: Array
    nu_dot: Array
    position: Array
    attitude: Array


def subtract(motion: Motion, prediction: Prediction) -> Errors:
    """Errors of one prediction at usable samples; infinite where it diverged.

    NaN for what was not measured.
    """
    both = motion.usable & ~np.isnan(prediction.nu).any(axis=1)
    moved = both & ~np.isnan(prediction.nu_dot).any(axis=1) & np.isfinite(motion.nu_dot).all(axis=1)
    with np.errstate(invalid="ignore"):
        turn = log(multiply(conjugate(motion.eta[both, 3:]), prediction.eta[both, 3:]))
    place, angle = _posed(motion.measured)
    return Errors(
        blank(motion.measured, prediction.nu[both] - motion.nu[both], np.nan),
        blank(motion.measured, prediction.nu_dot[moved] - motion.nu_dot[moved], np.nan),
        place * np.linalg.norm(prediction.eta[both, :3] - motion.eta[both, :3], axis=1),
        angle * np.linalg.norm(turn, axis=1),
    )


def _posed(measured: Measured | None) -> tuple[float, float]:
    """1 where the whole position, the whole attitude was measured; else NaN."""
    if measured is None:
        return 1.0, 1.0
    place, angle = measured.coordinates.all(), measured.axes[3:].all()
    return (1.0 if place else np.nan), (1.0 if angle else np.nan)


def pool(parts: Sequence[Errors]) -> Errors:
    """Errors of several runs as one set of samples."""
    names = ("nu", "nu_dot", "position", "attitude")
    return Errors(*(np.concatenate([getattr(p, name) for p in parts]) for name in names))


def rms(x: Array) -> Array:
    """Root mean square over the first axis; NaN where there is nothing."""
    if not len(x):
        return np.full(x.shape[1:], np.nan)
    with np.errstate(over="ignore"):  # of a model that diverged: infinite
        return np.sqrt(np.mean(np.square(x), axis=0))


def mean_absolute(x: Array) -> Array:
    """Mean absolute value over the first axis; NaN where there is nothing."""
    return np.mean(np.abs(x), axis=0) if len(x) else np.full(x.shape[1:], np.nan)


def summarize(errors: Errors) -> Metrics:
    """The metrics of contract section 3; None where the model left the finite numbers."""
    return Metrics(
        acceleration_rmse=ByAxis.of(rms(errors.nu_dot)),
        velocity_mae=ByAxis.of(mean_absolute(errors.nu)),
        velocity_rmse=ByAxis.of(rms(errors.nu)),
        position_rmse_m=or_none(float(rms(errors.position))),
        attitude_rmse_rad=or_none(float(rms(errors.attitude))),
    )


def score(motion: Motion, replay: Replay) -> RunErrors:
    """All metrics of one model on one run."""
    found = {name: summarize(subtract(motion, p)) for name, p in replay.horizons.items()}
    return RunErrors(
        split=motion.run.split,
        control=motion.run.control,
        open_loop=found.pop(OPEN_LOOP),
        windows=found,
    )


def score_all(motions: Sequence[Motion], replays: Mapping[str, Mapping[str, Replay]]) -> Comparison:
    """`comparison.json` of replays by model and run."""
    models = {
        name: ModelErrors(runs={m.run.id: score(m, runs[m.run.id]) for m in motions})
        for name, runs in replays.items()
    }
    return Comparison(models=models)


def normalize(motions: Sequence[Motion], velocity_rmse: Array) -> float | None:
    """Velocity RMSE (6,) over the standard deviation of the measured velocity, mean over axes.

    Only axes that were excited count: an axis nobody moved cannot be judged.
    """
    nu = np.concatenate([m.nu[m.usable] for m in motions])
    spread = np.std(nu, axis=0)
    moved = spread > EXCITED
    return or_none(np.mean(velocity_rmse[moved] / spread[moved])) if moved.any() else None


def trace_growth(motions: Sequence[Motion], replays: Sequence[Replay], horizon: str = "5") -> Curve:
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
    columns = {a: tuple(map(or_none, row)) for a, row in zip(AXES, rows.T, strict=True)}
    return Curve(horizon_s=tuple(float(edges[b]) for b in kept), velocity_rmse=columns)


def _age(motion: Motion, prediction: Prediction, horizon: float) -> Array:
    """Time since the anchor of the window each sample belongs to, s."""
    age = np.full(len(motion.time), np.nan)
    for a, b in find_windows(motion, horizon):
        at = slice(a, b) if motion.binned else slice(a + 1, b + 1)
        age[at] = motion.time[at] - motion.time[a]
    return age
