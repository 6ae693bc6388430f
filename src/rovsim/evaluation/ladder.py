"""The ladder: errors of one model after the other, on runs that none was fitted to."""

from dataclasses import dataclass, field
from typing import Iterable

import numpy as np

from rovsim.core.horizons import STANDARD_HORIZON
from rovsim.evaluation.error_metrics import Errors, ErrorSums, VelocityMoments, normalize, subtract
from rovsim.measurement.signals.motion import Motion
from rovsim.results.ladder import LadderStep
from rovsim.simulation.prediction import Replay


@dataclass(eq=False)
class StepScore:
    """Collects a model's error in windows of 2 s, pooled over all runs of a split.

    Attributes:
        model: its name.
        split: runs of other splits are ignored.
        diverges_in: ids of runs in which the model diverges. The pooled error is then None.
    """

    model: str
    split: str = "test"
    diverges_in: list[str] = field(default_factory=list)
    _errors: ErrorSums = field(default_factory=ErrorSums.nothing)
    _measured: VelocityMoments = field(default_factory=VelocityMoments.nothing)

    def add(self, motion: Motion, errors: Errors) -> None:
        """Add a run and the errors in its windows of 2 s; ignore a run of another split."""
        if motion.run.split != self.split:
            return
        sums = ErrorSums.of(errors)
        if not np.isfinite(sums.nu_squared).all():
            self.diverges_in.append(motion.run.id)
        self._errors += sums
        self._measured += VelocityMoments.of(motion)

    @property
    def step(self) -> LadderStep:
        """The step of the ladder; its numbers are None where there was no run."""
        if not self._errors.samples.any():
            return LadderStep(model=self.model, split=self.split)
        metrics = self._errors.metrics()
        return LadderStep(
            model=self.model,
            split=self.split,
            acceleration_rmse=metrics.acceleration_rmse,
            velocity_mae=metrics.velocity_mae,
            windows_2s=normalize(self._measured.std, self._errors.velocity_rmse),
        )


def score_step(
    name: str, pairs: Iterable[tuple[Motion, Replay]], split: str = "test"
) -> LadderStep:
    """The step of a model, from runs and their replays."""
    score = StepScore(name, split)
    for motion, replay in pairs:
        score.add(motion, subtract(motion, replay.horizons[STANDARD_HORIZON]))
    return score.step
