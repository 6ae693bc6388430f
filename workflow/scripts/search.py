"""Find the conditions under which one model's errors are large."""

from rovsim.application.pipeline.error_conditions import find_error_conditions
from rovsim.application.sections import SimulationSections
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        found = find_error_conditions(
            model=rule.model(rule.wildcards.model),
            motions=rule.motions(),
            settings=rule.section(SimulationSections),
        )
        found.write(rule.output())
