"""Diagnose which effects the nominal model lacks."""

from rovsim.application.pipeline.diagnosis import diagnose
from rovsim.application.snakemake_job import job
from rovsim.diagnosis.settings import DiagnosisSettings

if __name__ == "__main__":
    with job(snakemake) as rule:
        found = diagnose(
            campaign=rule.campaign,
            runs=rule.runs(),
            base=rule.model("nominal"),
            settings=rule.section(DiagnosisSettings),
            catalogue=rule.catalogue,
        )
        found.write(rule.output())
