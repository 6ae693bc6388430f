"""Score one replay."""

from pathlib import Path

from rovsim.files import write_json
from rovsim.jobs import job
from rovsim.replay import Replay
from rovsim.scores import score
from rovsim.signals.motion import Motion


def main(*, motion: Path, replay: Path, out: Path) -> None:
    write_json(out, score(Motion.read(motion), Replay.read(replay)))


if __name__ == "__main__":
    with job(snakemake):
        main(
            motion=Path(snakemake.input.motion),
            replay=Path(snakemake.input.replay),
            out=Path(snakemake.output[0]),
        )
