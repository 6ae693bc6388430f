"""Score all replays of one model."""

from rovsim.application.snakemake_job import job
from rovsim.evaluation.scored import Scored

if __name__ == "__main__":
    with job(snakemake) as rule:
        Scored.of(rule.motions(), rule.replays()).comparison.write(rule.output())
