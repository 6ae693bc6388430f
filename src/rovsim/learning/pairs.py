"""Training pairs for a learned residual: features, and the acceleration that the model lacks."""

from dataclasses import dataclass, field
from typing import Any, Iterable, Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.dynamics.learned.settings import FeatureSettings
from rovsim.dynamics.model import Model
from rovsim.learning.learner import spread_rows
from rovsim.measurement.quality.unlogged_commands import keep_logged
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.samples import Samples, sample_run
from rovsim.simulation.settings import SimulationSettings

MAX_ROWS = 1 << 18  # 44 min at 100 Hz, some 40 MB; of more, every second, fourth, ... is kept


def flown_with(control: str, run: Any) -> bool:
    """Whether a run was flown with this control; `all` includes every run."""
    return control in ("all", run.control)


def _refuse_parts(motion: Motion) -> None:
    """Refuse a run of which not all six axes were measured."""
    measured = np.ones(6, bool) if motion.measured is None else motion.measured.axes
    if not measured.all():
        missing = ", ".join(axis for axis, shown in zip(AXES, measured, strict=True) if not shown)
        raise BadInput(
            f"nothing was measured of {missing}",
            where=f"run {motion.run.id}",
            expected="all six axes, which a residual learns together",
            remedy="Add effects instead (rovsim diagnose), or train on runs with full poses.",
        )


def training_runs(motions: Iterable[Motion], control: str) -> Iterator[Motion]:
    """Yield the train runs with this control of which something can be used, one after the other.

    Stretches of which nobody knows what was commanded are not usable in them.

    Raises:
        BadInput: there is no such run, or not all axes of one were measured.
    """
    descriptions, empty = [], True
    for motion in map(keep_logged, motions):
        facts = [motion.run.control, motion.run.split]
        facts += [] if motion.usable.any() else ["nothing of it can be used"]
        descriptions.append(f"{motion.run.id} ({', '.join(facts)})")
        wanted = motion.run.split == "train" and flown_with(control, motion.run)
        if wanted and motion.usable.any():
            _refuse_parts(motion)
            empty = False
            yield motion
    if empty:
        raise BadInput(
            f"no train run with control {control} that can be used",
            where="campaign.yaml",
            expected="at least one run with that control and split: train",
            remedy=f"Its runs are {', '.join(descriptions)}. "
            "Train with the other control (in a study: study.controls), or record such a run.",
        )


@dataclass
class Gathered:
    """Training pairs, gathered run by run; at most `most` rows are kept, spread over all runs.

    Attributes:
        features: settings of the features.
        seed: of the choice of rows.
        most: largest number of rows to keep; at least one of each run is kept.
        runs: ids of the runs so far.
        rows: total number of rows of these runs.
    """

    features: FeatureSettings
    seed: int
    most: int = MAX_ROWS
    runs: list[str] = field(default_factory=list)
    rows: int = 0
    _every: int = 1
    _kept: list[tuple[Array, Array]] = field(default_factory=list)

    def take(self, run: str, samples: Samples) -> None:
        """Add the samples of a run; where there are too many rows, keep every second one of all."""
        pairs = samples.features(self.features), samples.a_res
        self.runs.append(run)
        self.rows += len(samples.a_res)
        self._kept.append(self._thinned(pairs, self._every))
        while sum(len(Y) for _, Y in self._kept) > max(self.most, len(self.runs)):
            self._every *= 2
            self._kept = [self._thinned(block, 2) for block in self._kept]

    def _thinned(self, pairs: tuple[Array, Array], every: int) -> tuple[Array, Array]:
        """Keep one of `every` rows of X (n, d) and Y (n, 6)."""
        X, Y = pairs
        rows = spread_rows(len(Y), -(-len(Y) // every), self.seed)
        return X[rows], Y[rows]

    @property
    def pairs(self) -> tuple[Array, Array]:
        """Features X (n, d), and residual accelerations Y (n, 6) in m/s2 and rad/s2."""
        X, Y = zip(*self._kept, strict=True)
        return np.concatenate(X), np.concatenate(Y)


def gather_pairs(
    model: Model,
    motions: Iterable[Motion],
    control: str,
    features: FeatureSettings,
    settings: SimulationSettings,
    seed: int,
) -> Gathered:
    """Gather the pairs from which a residual on top of a model learns.

    Args:
        model: of physics alone.
        motions: the runs of a campaign, of which train runs with this control are used.
        control: `3dof`, `6dof` or `all`.
        features: settings of the features.
        settings: filter and derivative of the measurement, step length, and how commands are held.
        seed: of the choice of rows.

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
        gathered.take(motion.run.id, sample_run(model, motion, settings))
    return gathered
