"""Split all runs anew: one for test, all others to train on."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.evaluation.held_out.folds import held_out
from rovsim.measurement.signals.chain import read_stage
from rovsim.measurement.signals.motion import Motion


def main(*, motions: list[Path], stages: list[Path], test: str, out: dict[str, list[Path]]) -> None:
    for path, target in zip(motions, out["motions"], strict=True):
        held_out(Motion.read(path), test).write(target)
    for path, target in zip(stages, out["stages"], strict=True):
        held_out(read_stage(path), test).write(target)


if __name__ == "__main__":
    with job(snakemake):
        main(
            motions=[Path(path) for path in snakemake.input.motions],
            stages=[Path(path) for path in snakemake.input.stages],
            test=snakemake.wildcards.fold,
            out={
                name: [Path(path) for path in snakemake.output[name]]
                for name in ("motions", "stages")
            },
        )
