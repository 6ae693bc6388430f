"""Budget of forces of the nominal model over one run."""

from rovsim.application.pipeline.forces import balance_run
from rovsim.application.sections import SimulationSettings
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        (motion,) = rule.motions("motion")
        balance_run(
            model=rule.model("nominal"),
            motion=motion,
            settings=rule.section(SimulationSettings),
        ).write(rule.output())
