"""Replay and score the held-out run with every model of its fold."""

from pathlib import Path

from rovsim.application.loading import campaign_vehicle
from rovsim.application.snakemake_job import job
from rovsim.application.study import BASELINES
from rovsim.core.files import write_json
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model_file import load_model, read_model
from rovsim.evaluation.scores import comparison, score
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.replay import replay
from rovsim.simulation.settings import rule_settings


def main(
    *, motion: Path, campaign: Path, models: list[Path], out: Path, settings: dict,
    catalogue: Catalogue,
) -> None:  # fmt: skip
    vehicle, held = campaign_vehicle(load_campaign(campaign)), Motion.read(motion)
    chosen = [load_model(name, vehicle, catalogue) for name in BASELINES]
    chosen += [read_model(path, catalogue).called(path.parent.name) for path in models]
    signals, how = rule_settings(settings)
    found = comparison(score(held, replay(model, held, signals, how)) for model in chosen)
    write_json(out, found)


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
