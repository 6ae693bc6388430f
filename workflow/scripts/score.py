"""Score all replays of one model."""

from rovsim.application.snakemake_job import job
from rovsim.evaluation.score_collector import ScoreCollector

if __name__ == "__main__":
    with job(snakemake) as rule:
        ScoreCollector.of(rule.motions(), rule.replays()).comparison.write(rule.output())
