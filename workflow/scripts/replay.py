"""Replay one run through one model."""

from pathlib import Path

from rovsim.application.loading import campaign_vehicle
from rovsim.application.snakemake_job import job
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model_file import load_model
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import rule_settings


def main(
    *, motion: Path, campaign: Path, file: str, name: str, out: Path, settings: dict,
    catalogue: Catalogue,
) -> None:  # fmt: skip
    vehicle = campaign_vehicle(load_campaign(campaign))
    model = load_model(file or name, vehicle, catalogue).called(name)
    signals, how = rule_settings(settings)
    replay(model, Motion.read(motion), signals, how).write(out)


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(
            catalogue=catalogue,
            motion=Path(snakemake.input.motion),
            campaign=Path(snakemake.input.campaign),
            file=str(snakemake.input.get("model") or ""),
            name=snakemake.wildcards.model,
            out=Path(snakemake.output[0]),
            settings=snakemake.params.settings,
        )
