"""Derive velocities and accelerations; an unusable run keeps none."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from rovsim.application.snakemake_job import job
from rovsim.core.files import read_json
from rovsim.core.schema import checked
from rovsim.measurement.signals.chain import SignalSettings, differentiated, read_stage


def main(*, poses: Path, quality: Path, out: Path, signals: dict) -> None:
    motion = differentiated(read_stage(poses), checked(SignalSettings, signals, "conf"))
    if read_json(quality)["unusable"]:
        motion = replace(motion, usable=np.zeros_like(motion.usable))
    motion.write(out)


if __name__ == "__main__":
    with job(snakemake):
        main(
            poses=Path(snakemake.input.poses),
            quality=Path(snakemake.input.quality),
            out=Path(snakemake.output[0]),
            signals=snakemake.params.signals,
        )
