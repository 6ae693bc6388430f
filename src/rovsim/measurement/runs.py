"""The usable runs of a campaign, as a diagnosis needs them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

from rovsim.core.bounded_cache import Remade
from rovsim.measurement.signals.chain import Stage, read_stage
from rovsim.measurement.signals.motion import Motion


@dataclass(frozen=True, eq=False)
class Runs:
    """Usable runs, by id.

    Attributes:
        motions: the processed runs.
        stages: what goes into the signal filter: poses, or binned recordings.
        splits: `train` or `test`.
    """

    motions: Mapping[str, Motion]
    stages: Mapping[str, Stage]
    splits: Mapping[str, str]

    @staticmethod
    def read(motions: Sequence[Path], stages: Sequence[Path]) -> "Runs":
        """Find the usable runs in what the signal chain wrote; they are read when needed.

        Args:
            motions: files of the motions.
            stages: files of the same runs before the signal filter, in the same order.
        """
        places, splits = {}, {}
        for paths in zip(motions, stages, strict=True):
            motion = Motion.read(paths[0])
            if motion.usable.any():
                places[motion.run.id], splits[motion.run.id] = paths, motion.run.split
        return Runs(
            Remade(places, lambda run: Motion.read(places[run][0])),
            Remade(places, lambda run: read_stage(places[run][1])),
            splits,
        )

    def of(self, split: str) -> list[str]:
        """Ids of the runs of a split."""
        return [run for run in self.motions if self.splits[run] == split]
