"""Fly the synthetic campaign."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.schema import checked
from rovsim.dynamics.catalogue import Catalogue
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings


def main(*, folder: Path, settings: dict, catalogue: Catalogue) -> None:
    make_campaign(checked(TankSettings, settings, "conf/tank"), folder, catalogue)


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(
            catalogue=catalogue,
            folder=Path(snakemake.params.folder),
            settings=snakemake.params.settings,
        )
