"""Write the nominal model with the effects that its diagnosis selected."""

from rovsim.application.pipeline.models import write_with_effects
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        write_with_effects(
            diagnosis=rule.path("diagnosis"),
            base="nominal",
            effects=None,
            catalogue=rule.catalogue,
            out=rule.output(),
            story={},
        )
