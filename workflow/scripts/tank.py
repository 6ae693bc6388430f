"""Fly the synthetic campaign."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.schema import checked
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings


def main(*, folder: Path, settings: dict) -> None:
    make_campaign(checked(TankSettings, settings, "conf/tank"), folder)


if __name__ == "__main__":
    with job(snakemake):
        main(
            folder=Path(snakemake.params.folder),
            settings=snakemake.params.settings,
        )
