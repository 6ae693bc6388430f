"""Training pairs for a learned residual: features, and what the model's acceleration misses.

Teacher-forced: the model is evaluated at the measured state, a_res = a_real - a_sim.
"""

from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.dynamics.engine.types import Inputs
from rovsim.dynamics.learned.features import FeatureSettings, assemble
from rovsim.dynamics.model import Model
from rovsim.learning.learner import LearnerSettings, Progress, Trained, train
from rovsim.measurement.signals.binned import backward_difference, bin_means
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.initial_memory import measured_memory
from rovsim.simulation.replay import (
    ReplaySettings,
    as_true,
    clock,
    inputs,
    place,
    residual_data,
    state_at,
    trajectories,
)


@dataclass(frozen=True, eq=False)
class Samples:
    """What a residual may look at and should predict, n samples of one run.

    `index` (n,) into motion.time; `nu` (n, 6), `attitude` (n, 4), `wrench` (n, 6) of the thrusters,
    `a_sim` (n, 6) instantaneous acceleration of the model there, `a_res` (n, 6) what it misses.
    """

    index: Array
    nu: Array
    attitude: Array
    wrench: Array
    a_sim: Array
    a_res: Array

    def features(self, settings: FeatureSettings) -> Array:
        """Features X (n, d)."""
        return assemble(settings, self.nu, self.a_sim, self.wrench, self.attitude)


def samples(
    model: Model, motion: Motion, signals: SignalSettings, settings: ReplaySettings
) -> Samples:
    """Samples of one run at its usable instants.

    All in true axes at CO: where the model says that the motion capture sees another point or other
    axes, the measurement is turned back first, so that tau_res = M a_res in a free replay.
    """
    motion = as_true(model, motion)
    found = _of_bins if motion.binned else _of_samples
    return found(model, motion, signals, settings)


def accelerations(model: Model, motion: Motion, at: Inputs) -> Array:
    """Acceleration (n, 6) of the model at the motion's states, under the thrust of step n."""
    out = np.empty((len(motion.time), 6))
    model.engine.accelerations(
        motion.time - motion.time[0], motion.state, measured_memory(model, motion, motion.time),
        model.constants, at,
        model.wrench_parameters()[None], residual_data(model), place(motion), out,
    )  # fmt: skip
    return out


def _of_samples(model, motion, signals, settings) -> Samples:
    """At each sample, under the thrust around it; the model's acceleration is filtered too."""
    steps = clock(motion, settings.step)
    at = _around(inputs(model, motion, steps.edges, settings.commands), steps.stride)
    a_sim = accelerations(model, motion, at)
    period = float(motion.time[1] - motion.time[0])
    kept = [np.arange(a, b) for a, b in motion.segments()]
    like = np.concatenate(
        [signals.filter.smoothed(a_sim[k], period) for k in kept] or [np.empty((0, 6))]
    )
    index = np.concatenate([*kept, np.arange(0)])
    return Samples(
        index, motion.nu[index], motion.eta[index, 3:], at.wrench[0, index], a_sim[index],
        motion.nu_dot[index] - like,
    )  # fmt: skip


def _around(steps: Inputs, stride: int) -> Inputs:
    """Inputs at samples: the mean of the steps on either side."""

    def mean(x: Array) -> Array:
        x = x.reshape(-1, stride, x.shape[-1]).mean(axis=1)
        return 0.5 * (np.vstack([x[:1], x]) + np.vstack([x, x[-1:]]))

    demand = mean(steps.demand)
    return Inputs(
        mean(steps.wrench[0])[None], mean(steps.force[0])[None], demand, steps.row,
        np.full(len(demand), steps.duration[0]),
    )  # fmt: skip


def _of_bins(model, motion, signals, settings) -> Samples:
    """At each bin's start; the model makes the same backward difference of means of two bins."""
    steps = clock(motion, settings.step)
    edges = np.append(motion.time, motion.end)
    fits = motion.usable[1:] & motion.usable[:-1] & np.isfinite(motion.nu_dot[1:]).all(axis=1)
    index = 1 + np.flatnonzero(fits)
    nearest = np.clip(np.round((edges - edges[0]) / steps.h).astype(int), 0, len(steps.edges) - 1)
    begins, ends = nearest[index - 1], np.maximum(nearest[index + 1], nearest[index - 1] + 1)
    starts = [
        (int(b), int(e - b), state_at(motion, steps.edges[b]))
        for b, e in zip(begins, ends, strict=True)
    ]
    a_real_like = np.empty((len(index), 6))
    for row, (k, path) in enumerate(
        zip(index, trajectories(model, motion, starts, settings), strict=True)
    ):
        fine = steps.edges[starts[row][0] : starts[row][0] + len(path)]
        two = bin_means(fine, path[:, 7:], np.clip(edges[k - 1 : k + 2], fine[0], fine[-1]))
        a_real_like[row] = backward_difference(two, motion.time[k - 1 : k + 1])[1]
    at = _over_bins(inputs(model, motion, steps.edges, settings.commands), nearest)
    a_sim = accelerations(model, motion, at)[index]
    return Samples(
        index, motion.state_nu[index], motion.eta[index, 3:], at.wrench[0, index], a_sim,
        motion.nu_dot[index] - a_real_like,
    )  # fmt: skip


def _over_bins(steps: Inputs, nearest: Array) -> Inputs:
    """Inputs at bin starts: the mean over the bins before and after."""

    def mean(x: Array) -> Array:
        total = np.vstack([np.zeros(x.shape[-1]), np.cumsum(x, axis=0)])
        a, b = nearest[np.maximum(np.arange(len(nearest) - 1) - 1, 0)], nearest[1:]
        return (total[b] - total[a]) / np.maximum(b - a, 1)[:, None]

    demand = mean(steps.demand)
    return Inputs(
        mean(steps.wrench[0])[None], mean(steps.force[0])[None], demand, steps.row,
        np.full(len(demand), steps.duration[0]),
    )  # fmt: skip


def at_samples(model: Model, motion: Motion, settings: ReplaySettings) -> Inputs:
    """Inputs of one model at every measured instant: means over the steps or bins around it."""
    steps = clock(motion, settings.step)
    found = inputs(model, motion, steps.edges, settings.commands)
    if not motion.binned:
        return _around(found, steps.stride)
    nearest = np.round((np.append(motion.time, motion.end) - motion.time[0]) / steps.h).astype(int)
    return _over_bins(found, np.clip(nearest, 0, len(steps.edges) - 1))


def flown_with(control: str, run: Any) -> bool:
    """Whether a run (with its `control`) is one of those that `control` means; `all` means each."""
    return control in ("all", run.control)


def training_runs(motions: Sequence[Motion], control: str) -> list[Motion]:
    """The runs a residual of this control may learn from.

    Raises:
        BadInput: the campaign has none.
    """
    chosen = [m for m in motions if m.run.split == "train" and flown_with(control, m.run)]
    if chosen:
        return chosen
    runs = ", ".join(f"{m.run.id} ({m.run.control}, {m.run.split})" for m in motions)
    raise BadInput(
        f"no train run with control {control}",
        where="campaign.yaml",
        expected="at least one run with that control and split: train",
        remedy=f"Its runs are {runs}. Train with the other control, or record such a run.",
    )


def train_residual(
    model: Model,
    motions: Sequence[Motion],
    control: str,
    learner: LearnerSettings,
    signals: SignalSettings,
    settings: ReplaySettings,
    seed: int,
    progress: Progress = lambda done, total: None,
) -> Trained:
    """Train a residual on top of a model, on the train runs with this control.

    Raises:
        BadInput: the model has a residual already, or there is nothing to train on.
    """
    if model.residual is not None:
        raise BadInput(
            "has a trained residual already",
            where=f"model {model.name}",
            expected="a model of physics alone",
            remedy="Train on the model that residual was trained on.",
        )
    found = [samples(model, m, signals, settings) for m in training_runs(motions, control)]
    X = np.concatenate([s.features(learner.features) for s in found])
    Y = np.concatenate([s.a_res for s in found])
    return train(X, Y, learner, seed, progress)
