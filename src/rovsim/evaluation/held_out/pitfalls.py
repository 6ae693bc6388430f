"""Repeat four mistakes of the thesis' public code on purpose, to see what each of them costs."""

from dataclasses import replace
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.horizons import OPEN_LOOP
from rovsim.dynamics.learned.residual import Residual
from rovsim.dynamics.learned.settings import Control
from rovsim.dynamics.model import Model
from rovsim.evaluation.error_metrics import measured_spread, normalize, rms, subtract
from rovsim.learning.learner import train
from rovsim.learning.settings import LearnerSettings
from rovsim.measurement.signals.binned import backward_difference
from rovsim.measurement.signals.motion import Motion
from rovsim.results.pitfalls import Cost
from rovsim.simulation.replay import replay
from rovsim.simulation.samples import Samples, sample_run
from rovsim.simulation.settings import SimulationSettings

ASSUMED_BIN_WIDTH_S = 0.1  # s, the bin that the public code replays with
# standard deviations from all training data: there a Gaussian process knows no data
FAR_SIGMAS = 1e6


def on_wrong_clock(motion: Motion) -> Motion:
    """Change the clock of a binned run as if each bin lasted 0.1 s; its commands move along."""
    edges = np.append(motion.time, motion.end)
    clock = motion.time[0] + ASSUMED_BIN_WIDTH_S * np.arange(len(edges))
    arrival = np.interp(motion.commands.time, edges, clock)
    return replace(
        motion,
        time=clock[:-1],
        end=float(clock[-1]),
        nu_dot=backward_difference(motion.nu, clock[:-1]),
        commands=replace(motion.commands, time=arrival),
    )


def replay_error(model: Model, motion: Motion, settings: SimulationSettings) -> float | None:
    """Normalised velocity RMSE of an open-loop replay (`error_metrics.normalize`)."""
    prediction = replay(model, motion, settings).horizons[OPEN_LOOP]
    return normalize(measured_spread([motion]), rms(subtract(motion, prediction).nu))


def explained(predict: Callable[[Array], Array], X: Array, Y: Array) -> float:
    """Share of the residual acceleration that is predicted, mean over axes.

    Below zero, predictions are worse than none.

    Args:
        predict: from features (n, d) to residual accelerations (n, 6).
        X: features (n, d).
        Y: residual accelerations (n, 6), m/s2 and rad/s2.
    """
    return float(np.mean(1.0 - np.mean((Y - predict(X)) ** 2, axis=0) / np.mean(Y**2, axis=0)))


def measure_pitfalls(
    model: Model,
    runs: Sequence[Motion],
    test: Motion,
    learners: dict[str, LearnerSettings],
    settings: SimulationSettings,
) -> dict[str, Cost]:
    """Measure the cost of each mistake that can be made on one held-out run.

    The wrong clock is only tried on a binned run, and measured by `replay_error`; the other
    mistakes are measured by what is `explained`. Copied runs are only tried where there are train
    runs of both controls.

    Args:
        model: a model without a learned residual.
        runs: the training runs, of both controls.
        test: the held-out run.
        learners: settings of `knn` and `gp`.
        settings: of the filter of the measurement, and of replays.

    Returns:
        The number without the mistake (`right`) and with it (`wrong`), by name of the mistake.
    """
    samples = {m.run.id: sample_run(model, m, settings) for m in runs}
    test_samples = sample_run(model, test, settings)
    planar = [samples[m.run.id] for m in runs if m.run.control == "3dof"]
    full = [samples[m.run.id] for m in runs if m.run.control == "6dof"]
    costs: dict[str, Cost] = {}
    if test.binned:
        costs["wrong clock"] = _cost_of_wrong_clock(model, test, settings)
    costs |= _costs_of_a_broken_gp(list(samples.values()), test_samples, learners["gp"])
    if planar and full:
        costs["copied runs"] = _cost_of_copies(planar, full, test_samples, learners["knn"])
    return costs


def _cost_of_wrong_clock(model: Model, test: Motion, settings: SimulationSettings) -> Cost:
    return Cost(
        right=replay_error(model, test, settings),
        wrong=replay_error(model, on_wrong_clock(test), settings),
    )


def _costs_of_a_broken_gp(
    runs: Sequence[Samples], test: Samples, learner: LearnerSettings
) -> dict[str, Cost]:
    """Ask a Gaussian process far from all its data, and with features that were scaled before."""
    gp = _trained(runs, learner, "all")
    X = _X(test, gp)
    scale = np.maximum(np.std(np.concatenate([_X(s, gp) for s in runs]), axis=0), 1e-9)
    right, far, twice = (
        explained(gp.predict, x, test.a_res) for x in (X, X + FAR_SIGMAS * scale, X / scale)
    )
    return {
        "lost data": Cost(right=right, wrong=far),
        "scaled twice": Cost(right=right, wrong=twice),
    }


def _cost_of_copies(
    planar: Sequence[Samples], full: Sequence[Samples], test: Samples, learner: LearnerSettings
) -> Cost:
    """Learn from copies of 3-DoF runs in place of the 6-DoF runs."""
    knn = _trained(full, learner, "6dof")
    copy = _trained([*planar] * len(full), learner, "3dof")
    X = _X(test, knn)
    return Cost(
        right=explained(knn.predict, X, test.a_res),
        wrong=explained(copy.predict, X, test.a_res),
    )


def _X(one: Samples, residual: Residual) -> Array:
    """Features (n, d) of the samples of a run, as a residual takes them."""
    return one.features(residual.features)


def _trained(runs: Sequence[Samples], learner: LearnerSettings, control: Control) -> Residual:
    """Train a residual on the samples of some runs of a control."""
    X = np.concatenate([s.features(learner.features) for s in runs])
    return train(X, np.concatenate([s.a_res for s in runs]), learner, seed=0, control=control)
