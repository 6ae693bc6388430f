"""Refit the nominal model's own parameters."""

from rovsim.application.pipeline.refit import refit
from rovsim.application.snakemake_job import job
from rovsim.diagnosis.settings import DiagnosisSettings

if __name__ == "__main__":
    with job(snakemake) as rule:
        refit(
            runs=rule.runs(),
            base=rule.model("nominal"),
            settings=rule.section(DiagnosisSettings),
            catalogue=rule.catalogue,
            out=rule.output(),
        )
