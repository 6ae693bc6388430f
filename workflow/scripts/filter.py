"""Smooth the poses of one run."""

from rovsim.application.snakemake_job import job
from rovsim.measurement.signals.chain import SignalSettings, filtered, read_stage

if __name__ == "__main__":
    with job(snakemake) as rule:
        filtered(read_stage(rule.path("poses")), rule.section(SignalSettings)).write(rule.output())
