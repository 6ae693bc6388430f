"""The usable runs of a campaign, as a diagnosis takes them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

from rovsim.core.bounded_cache import Remade
from rovsim.measurement.signals.chain import Stage, read_stage
from rovsim.measurement.signals.motion import Motion


@dataclass(frozen=True, eq=False)
class Runs:
    """Usable runs by id: as motions, their poses before the filter, and their splits."""

    motions: Mapping[str, Motion]
    stages: Mapping[str, Stage]
    splits: Mapping[str, str]

    @staticmethod
    def read(motions: Sequence[Path], stages: Sequence[Path]) -> "Runs":
        """Runs from what the signal chain wrote, in the same order; unusable ones are left out."""
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
