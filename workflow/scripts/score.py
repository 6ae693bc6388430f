"""Score all replays of one model."""

from rovsim.application.snakemake_job import job
from rovsim.core.files import write_json
from rovsim.evaluation.scores import score
from rovsim.simulation.prediction import Replay

if __name__ == "__main__":
    with job(snakemake) as rule:
        replays = map(Replay.read, rule.paths("replays"))
        pairs = zip(rule.motions(), replays, strict=True)
        write_json(rule.output(), [score(motion, replay) for motion, replay in pairs])
