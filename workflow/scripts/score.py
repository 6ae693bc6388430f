"""Score all replays of one model."""

from rovsim.application.snakemake_job import job
from rovsim.evaluation.scores import score_all
from rovsim.simulation.prediction import Replay

if __name__ == "__main__":
    with job(snakemake) as rule:
        replays = [Replay.read(path) for path in rule.paths("replays")]
        by_run = {replay.run.id: replay for replay in replays}
        score_all(rule.motions(), {replays[0].model: by_run}).write(rule.output())
