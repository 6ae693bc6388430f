"""Errors of many models in windows of 2 s, in one compiled call: what users see of a model.

The same number as `windows_2s` of the ladder, on the train runs, but for one thing: predictions are
not filtered once more. Disturbances may push, so the same code tells what noise alone would give.
"""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.innovations import drives, observing, remembered
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.actuation import Between
from rovsim.dynamics.model import Model
from rovsim.evaluation.scores import normalised, rms
from rovsim.measurement.signals.binned import bin_means
from rovsim.simulation.batch import Starts
from rovsim.simulation.windows import find_windows

SECONDS = 2.0  # contract, section 3


def score_windows(
    models: Sequence[Model], runs: Sequence[ObservedRun], between: Between = "held"
) -> tuple[Array, list[float | None]]:
    """Velocity RMSE (m, 6) of models in windows of 2 s, and the normalised mean of each.

    NaN for models that cannot exist.
    """
    able = [m for m in models if m.possible]
    parts = [differences(able, w, between) for w in runs]
    rmse = np.full((len(models), 6), np.nan)
    rmse[[m.possible for m in models]] = [
        rms(np.concatenate([p[k] for p in parts])) for k in range(len(able))
    ]
    return rmse, [normalised([w.motion for w in runs], row) for row in rmse]


def differences(
    models: Sequence[Model],
    run: ObservedRun,
    between: Between = "held",
    starts: Array | None = None,
    pushes: Array | None = None,
    seconds: float = SECONDS,
) -> Array:
    """Predicted minus measured velocity (m, n, 6) at the samples or bins of all windows.

    Args:
        models: to predict with.
        run: the run.
        between: how commands are held between two lines.
        starts: states (m, w, 13) as measured to start from; None: the measured ones.
        pushes: further wrench (m, k, 6) over the integration steps, N and N m.
        seconds: length of the windows.
    """
    spans = list(find_windows(run.motion, seconds))
    own = np.array([a for a, _ in spans], int)
    if starts is None:
        starts = np.tile(run.motion.state[own], (len(models), 1, 1))
    paths = _simulate(models, run, spans, starts, between, pushes)
    nu = [
        [m.mocap_view.twists(p[:, 7:]) for p in of_model]
        for m, of_model in zip(models, paths, strict=True)
    ]
    return np.array([_all_readings(run, spans, of_model) for of_model in nu])


def _all_readings(run: ObservedRun, spans: Sequence[tuple[int, int]], nu: Sequence[Array]) -> Array:
    parts = [_at_readings(run, span, v) for span, v in zip(spans, nu, strict=True)]
    return np.concatenate([np.empty((0, 6)), *parts])


def _simulate(
    models: Sequence[Model],
    run: ObservedRun,
    spans: Sequence[tuple[int, int]],
    starts: Array,
    between: Between,
    pushes: Array | None,
) -> list[list[Array]]:
    """States (steps + 1, 13) of each model and window, every integration step."""
    driven = drives(models, run, between)
    if pushes is not None:
        driven = [drive.pushed(push) for drive, push in zip(driven, pushes, strict=True)]
    first = np.array([run.ends[a] for a, _ in spans], np.int64)
    steps = np.array([run.ends[b] - run.ends[a] for a, b in spans], np.int64)
    begin = np.array([m.mocap_view.inverse.states(s) for m, s in zip(models, starts, strict=True)])
    memory = remembered(models, run, first)
    batch = observing(models, run)
    return batch.trajectories(driven, Starts(begin, first, steps, memory), run.h)


def _at_readings(run: ObservedRun, span: tuple[int, int], nu: Array) -> Array:
    """Predicted minus measured velocity at the samples or bins of one window."""
    a, b = span
    at, measured = run.ends[a : b + 1] - run.ends[a], run.motion.nu[readings(run, span)]
    if not run.motion.binned:
        return nu[at[1:]] - measured
    return bin_means(np.arange(len(nu), dtype=float), nu, at) - measured


def readings(run: ObservedRun, span: tuple[int, int]) -> slice:
    """The samples or bins at which a window is compared: it starts from its first sample."""
    first = 0 if run.motion.binned else 1
    return slice(span[0] + first, span[1] + first)
