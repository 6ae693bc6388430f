"""Repeat the mistakes of the thesis' public code, on each held-out run."""

from rovsim.application.pipeline.held_out import measure_pitfalls_by_run
from rovsim.application.sections import SimulationSections
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        found = measure_pitfalls_by_run(
            motions=rule.motions(),
            models=rule.models(),
            learners=rule.params.learners,
            settings=rule.section(SimulationSections),
        )
        found.write(rule.output())
