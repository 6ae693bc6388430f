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

ERROR = "velocity RMSE of the open loop, in standard deviations of the measured velocity"
SHARE = "share of the residual acceleration that is predicted"
# For each mistake, what was done, and which number is compared without it and with it.
PITFALLS = {
    "wrong clock": ("bins of about 0.157 s replayed as if each lasted 0.1 s", ERROR),
    "copied runs": ("a '6-DoF' training set that holds copies of a 3-DoF run (KNN)", SHARE),
    "lost data": ("a GP loaded with its hyperparameters but not its data", SHARE),
    "scaled twice": ("features scaled before they reach a GP that scales them", SHARE),
}
SAID = 0.1  # s, the bin that the public code replays with
FAR = 1e6  # standard deviations from all training data: there a Gaussian process knows no data


def on_wrong_clock(motion: Motion) -> Motion:
    """Change the clock of a binned run as if each bin lasted `SAID` s; its commands move along."""
    edges = np.append(motion.time, motion.end)
    clock = motion.time[0] + SAID * np.arange(len(edges))
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

    def taught(kind: str, names: Sequence[str], control: Control) -> tuple[Residual, Array]:
        residual = _trained([samples[name] for name in names], learners[kind], control)
        return residual, test_samples.features(residual.features)

    gp, X = taught("gp", list(samples), "all")
    scale = np.maximum(np.std(np.concatenate([_X(s, gp) for s in samples.values()]), axis=0), 1e-9)
    planar = [m.run.id for m in runs if m.run.control == "3dof"]
    full = [m.run.id for m in runs if m.run.control == "6dof"]
    costs: dict[str, Cost] = {}
    if test.binned:
        costs["wrong clock"] = Cost(
            right=replay_error(model, test, settings),
            wrong=replay_error(model, on_wrong_clock(test), settings),
        )
    right = explained(gp.predict, X, test_samples.a_res)
    far, twice = (
        explained(gp.predict, x, test_samples.a_res) for x in (X + FAR * scale, X / scale)
    )
    costs["lost data"] = Cost(right=right, wrong=far)
    costs["scaled twice"] = Cost(right=right, wrong=twice)
    if planar and full:
        (knn, K), (copy, _) = (
            taught("knn", full, "6dof"),
            taught("knn", planar * len(full), "3dof"),
        )
        score_of_copies = explained(copy.predict, K, test_samples.a_res)
        costs["copied runs"] = Cost(
            right=explained(knn.predict, K, test_samples.a_res), wrong=score_of_copies
        )
    return costs


def _X(one: Samples, residual: Residual) -> Array:
    """Features (n, d) of the samples of a run, as a residual takes them."""
    return one.features(residual.features)


def _trained(runs: Sequence[Samples], learner: LearnerSettings, control: Control) -> Residual:
    """Train a residual on the samples of some runs of a control."""
    X = np.concatenate([s.features(learner.features) for s in runs])
    return train(X, np.concatenate([s.a_res for s in runs]), learner, seed=0, control=control)
