"""Score all replays of one model."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import write_json
from rovsim.evaluation.scores import score
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.prediction import Replay


def main(*, motions: list[Path], replays: list[Path], out: Path) -> None:
    pairs = zip(map(Motion.read, motions), map(Replay.read, replays), strict=True)
    write_json(out, [score(motion, replay) for motion, replay in pairs])


if __name__ == "__main__":
    with job(snakemake):
        main(
            motions=[Path(path) for path in snakemake.input.motions],
            replays=[Path(path) for path in snakemake.input.replays],
            out=Path(snakemake.output[0]),
        )
