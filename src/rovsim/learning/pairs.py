"""Training pairs for a learned residual: features, and what the model's acceleration misses."""

from dataclasses import dataclass, field
from typing import Any, Iterable, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.core.errors import BadInput
from rovsim.dynamics.learned.settings import FeatureSettings
from rovsim.dynamics.model import Model
from rovsim.learning.learner import spread_rows
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.samples import Samples, sample_run
from rovsim.simulation.settings import SimulationSettings

MOST_ROWS = 1 << 18  # 44 min at 100 Hz, some 40 MB; of more, every second, fourth, ... is kept


def flown_with(control: str, run: Any) -> bool:
    """Whether a run (with its `control`) is one of those that `control` means; `all` means each."""
    return control in ("all", run.control)


def _refuse_parts(motion: Motion) -> None:
    known = np.ones(6, bool) if motion.measured is None else motion.measured.axes
    if not known.all():
        missing = ", ".join(axis for axis, yes in zip(AXES, known, strict=True) if not yes)
        raise BadInput(
            f"nothing was measured of {missing}",
            where=f"run {motion.run.id}",
            expected="all six axes, which a residual learns together",
            remedy="Add effects instead (rovsim diagnose), or train on runs with full poses.",
        )


def training_runs(motions: Iterable[Motion], control: str) -> Iterator[Motion]:
    """The runs a residual of this control may learn from, one after the other.

    Raises:
        BadInput: there is none, or one of them was measured in part only.
    """
    seen, none = [], True
    for motion in motions:
        seen.append(f"{motion.run.id} ({motion.run.control}, {motion.run.split})")
        if motion.run.split == "train" and flown_with(control, motion.run):
            _refuse_parts(motion)
            none = False
            yield motion
    if none:
        raise BadInput(
            f"no train run with control {control}",
            where="campaign.yaml",
            expected="at least one run with that control and split: train",
            remedy=f"Its runs are {', '.join(seen)}. "
            "Train with the other control, or record such a run.",
        )


@dataclass
class Gathered:
    """Training pairs, taken in run by run; memory holds `most` rows, spread over all runs.

    Of each run it keeps one row at least. `runs`: their ids. `rows`: how many they had.
    """

    features: FeatureSettings
    seed: int
    most: int = MOST_ROWS
    runs: list[str] = field(default_factory=list)
    rows: int = 0
    _every: int = 1
    _kept: list[tuple[Array, Array]] = field(default_factory=list)

    def take(self, run: str, samples: Samples) -> None:
        """Take in a run."""
        pairs = samples.features(self.features), samples.a_res
        self.runs.append(run)
        self.rows += len(samples.a_res)
        self._kept.append(self._thinned(pairs, self._every))
        while sum(len(Y) for _, Y in self._kept) > max(self.most, len(self.runs)):
            self._every *= 2
            self._kept = [self._thinned(kept, 2) for kept in self._kept]

    def _thinned(self, pairs: tuple[Array, Array], every: int) -> tuple[Array, Array]:
        X, Y = pairs
        rows = spread_rows(len(Y), -(-len(Y) // every), self.seed)
        return X[rows], Y[rows]

    @property
    def pairs(self) -> tuple[Array, Array]:
        """X (n, d), features, and Y (n, 6), residual accelerations in m/s2 and rad/s2."""
        X, Y = zip(*self._kept, strict=True)
        return np.concatenate(X), np.concatenate(Y)


def gather_pairs(
    model: Model,
    motions: Iterable[Motion],
    control: str,
    features: FeatureSettings,
    how: SimulationSettings,
    seed: int,
) -> Gathered:
    """What a residual on top of a model learns from: the train runs with this control.

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
    gathered = Gathered(features, seed)
    for motion in training_runs(motions, control):
        gathered.take(motion.run.id, sample_run(model, motion, how))
    return gathered
