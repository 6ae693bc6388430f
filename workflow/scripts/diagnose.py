"""Diagnose the nominal model."""

from pathlib import Path

from rovsim.application.loading import campaign_vehicle
from rovsim.application.snakemake_job import job
from rovsim.core.files import write_json
from rovsim.core.schema import checked
from rovsim.diagnosis.of_campaign import Runs, diagnosed
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import nominal
from rovsim.measurement.campaign import load_campaign


def main(
    *, motions: list[Path], stages: list[Path], campaign: Path, out: Path, settings: dict,
    catalogue: Catalogue,
) -> None:  # fmt: skip
    base = nominal(campaign_vehicle(load_campaign(campaign)))
    how = checked(DiagnosisSettings, settings, "conf")
    found = diagnosed(Runs.read(motions, stages), base, how, catalogue, lambda stage: None)
    write_json(out, found.content)


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(
            catalogue=catalogue,
            motions=[Path(path) for path in snakemake.input.motions],
            stages=[Path(path) for path in snakemake.input.stages],
            campaign=Path(snakemake.input.campaign),
            out=Path(snakemake.output[0]),
            settings=snakemake.params.settings,
        )
