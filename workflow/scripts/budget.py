"""Balance the forces of the nominal model over one run."""

from rovsim.application.sections import SimulationSections
from rovsim.application.snakemake_job import job
from rovsim.evaluation.force_budget import balance_forces

if __name__ == "__main__":
    with job(snakemake) as rule:
        (motion,) = rule.motions("motion")
        balance_forces(
            model=rule.model("nominal"),
            motion=motion,
            settings=rule.section(SimulationSections),
        ).write(rule.output())
