"""Add the effects that were found to the nominal model."""

from rovsim.application.pipeline.models import add_effects
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        add_effects(
            diagnosis=rule.path("diagnosis"),
            base="nominal",
            effects=None,
            catalogue=rule.catalogue,
            out=rule.output(),
            story={},
        )
