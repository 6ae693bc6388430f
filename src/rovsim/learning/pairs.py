"""Training pairs for a learned residual: features, and what the model's acceleration misses."""

from typing import Any, Sequence

import numpy as np

from rovsim import AXES
from rovsim.core.errors import BadInput
from rovsim.dynamics.model import Model
from rovsim.learning.learner import LearnerSettings, Progress, Trained, train
from rovsim.measurement.signals.chain import SignalSettings
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.samples import sample_run
from rovsim.simulation.settings import ReplaySettings


def flown_with(control: str, run: Any) -> bool:
    """Whether a run (with its `control`) is one of those that `control` means; `all` means each."""
    return control in ("all", run.control)


def _refuse_parts(motions: Sequence[Motion]) -> None:
    for motion in motions:
        known = np.ones(6, bool) if motion.measured is None else motion.measured.axes
        if not known.all():
            missing = ", ".join(axis for axis, yes in zip(AXES, known, strict=True) if not yes)
            raise BadInput(
                f"nothing was measured of {missing}",
                where=f"run {motion.run.id}",
                expected="all six axes, which a residual learns together",
                remedy="Add effects instead (rovsim diagnose), or train on runs with full poses.",
            )


def choose_training_runs(motions: Sequence[Motion], control: str) -> list[Motion]:
    """The runs a residual of this control may learn from.

    Raises:
        BadInput: the campaign has none, or one of them was measured in part only.
    """
    chosen = [m for m in motions if m.run.split == "train" and flown_with(control, m.run)]
    _refuse_parts(chosen)
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
    found = [
        sample_run(model, m, signals, settings) for m in choose_training_runs(motions, control)
    ]
    X = np.concatenate([s.features(learner.features) for s in found])
    Y = np.concatenate([s.a_res for s in found])
    return train(X, Y, learner, seed, progress)
