"""Budget of forces of the nominal model over one run."""

from pathlib import Path

from rovsim.application.loading import campaign_vehicle
from rovsim.application.snakemake_job import job
from rovsim.dynamics.model import nominal
from rovsim.evaluation.budget import budget
from rovsim.learning.pairs import sample_run
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.settings import rule_settings


def main(*, motion: Path, campaign: Path, out: Path, settings: dict) -> None:
    model = nominal(campaign_vehicle(load_campaign(campaign)))
    signals, how = rule_settings(settings)
    measured = Motion.read(motion)
    budget(model, measured, sample_run(model, measured, signals, how), how).write(out)


if __name__ == "__main__":
    with job(snakemake):
        main(
            motion=Path(snakemake.input.motion),
            campaign=Path(snakemake.input.campaign),
            out=Path(snakemake.output[0]),
            settings=snakemake.params.settings,
        )
