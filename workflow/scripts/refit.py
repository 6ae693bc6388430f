"""Refit the nominal model's own parameters."""

from pathlib import Path

from rovsim.application.loading import campaign_vehicle
from rovsim.application.snakemake_job import job
from rovsim.core.schema import checked
from rovsim.diagnosis.of_campaign import Runs
from rovsim.diagnosis.selection.nominal_refit import refit_nominal
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import nominal
from rovsim.dynamics.model_file import write_model
from rovsim.measurement.campaign import load_campaign
from rovsim.simulation.settings import ReplaySettings


def main(
    *, motions: list[Path], stages: list[Path], campaign: Path, out: Path, settings: dict,
    catalogue: Catalogue,
) -> None:  # fmt: skip
    base = nominal(campaign_vehicle(load_campaign(campaign)))
    how = checked(ReplaySettings, settings["replay"], "conf")
    train = Runs.read(motions, stages).prepare("train", how, catalogue)
    story = {"base": "nominal", "train_runs": [one.motion.run.id for one in train]}
    write_model(refit_nominal(base, train), out, provenance=story)


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
