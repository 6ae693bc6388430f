"""Time library call and exported predictor of every trained model."""

from pathlib import Path

from rovsim.application.loading import campaign_vehicle
from rovsim.application.settings import TimingSettings
from rovsim.application.snakemake_job import job
from rovsim.core.files import write_json
from rovsim.core.schema import checked
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import nominal
from rovsim.dynamics.model_file import read_model
from rovsim.evaluation.latency import both_ways
from rovsim.learning.pairs import sample_run
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.settings import rule_settings


def main(
    *, motion: Path, campaign: Path, models: list[Path], out: Path, settings: dict,
    catalogue: Catalogue,
) -> None:  # fmt: skip
    base = nominal(campaign_vehicle(load_campaign(campaign)))
    signals, how = rule_settings(settings)
    timing = checked(TimingSettings, settings["timing"], "conf")
    found = sample_run(base, Motion.read(motion), signals, how)
    inference = {}
    for path in models:
        residual = read_model(path, catalogue).residual
        queries = found.features(residual.features)
        inference[path.parent.name] = both_ways(
            residual, queries, timing.calls, timing.warmup, timing.seconds
        )
    write_json(out, {"inference": inference})


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(
            catalogue=catalogue,
            motion=Path(snakemake.input.motion),
            campaign=Path(snakemake.input.campaign),
            models=[Path(path) for path in snakemake.input.models],
            out=Path(snakemake.output[0]),
            settings=snakemake.params.settings,
        )
