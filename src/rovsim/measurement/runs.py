"""The usable runs of a campaign, as a diagnosis takes them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Sequence

from rovsim.measurement.signals.chain import Stage, read_stage
from rovsim.measurement.signals.motion import Motion


@dataclass(frozen=True, eq=False)
class Runs:
    """Usable runs by id: as motions, and their poses before the filter."""

    motions: Mapping[str, Motion]
    stages: Mapping[str, Stage]

    @staticmethod
    def read(motions: Sequence[Path], stages: Sequence[Path]) -> "Runs":
        """Runs from what the signal chain wrote, in the same order; unusable ones are left out."""
        pairs = zip(map(Motion.read, motions), map(read_stage, stages), strict=True)
        usable = [(motion, stage) for motion, stage in pairs if motion.usable.any()]
        return Runs(
            {motion.run.id: motion for motion, _ in usable},
            {motion.run.id: stage for motion, stage in usable},
        )
