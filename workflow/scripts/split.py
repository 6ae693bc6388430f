"""Split all runs anew: one to test on, all others to train on."""

from rovsim.application.snakemake_job import job
from rovsim.evaluation.held_out.folds import relabel_split
from rovsim.measurement.signals.chain import read_stage

if __name__ == "__main__":
    with job(snakemake) as rule:
        runs = {"motions": rule.motions(), "stages": map(read_stage, rule.paths("stages"))}
        for name, read in runs.items():
            for run, out in zip(read, rule.outputs()[name], strict=True):
                relabel_split(run, rule.wildcards.fold).write(out)
