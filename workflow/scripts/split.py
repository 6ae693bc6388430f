"""Split all runs anew: one to test on, all others to train on."""

from rovsim.application.snakemake_job import job
from rovsim.evaluation.held_out.folds import write_fold

if __name__ == "__main__":
    with job(snakemake) as rule:
        write_fold(
            test=rule.wildcards.fold,
            motions=rule.motions(),
            stages=rule.paths("stages"),
            out=rule.outputs(),
        )
