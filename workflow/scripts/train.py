"""Train one residual on the train runs of one control."""

from pathlib import Path

from rovsim.application.loading import campaign_vehicle
from rovsim.application.snakemake_job import job
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.learned.residual import write_residual
from rovsim.dynamics.model_file import load_model, write_model
from rovsim.learning.learner import learner_settings
from rovsim.learning.pairs import train_residual
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.settings import rule_settings


def main(
    *, motions: list[Path], campaign: Path, file: str, name: str, control: str, out: Path,
    residual: dict, settings: dict, catalogue: Catalogue,
) -> None:  # fmt: skip
    base = load_model(file or name, campaign_vehicle(load_campaign(campaign)), catalogue)
    runs = [Motion.read(path) for path in motions]
    learner = learner_settings(residual, "conf/residual")
    signals, how = rule_settings(settings)
    trained = train_residual(base, runs, control, learner, signals, how, settings["seed"])
    description = write_residual(out.parent, trained.residual(control))
    story = {"base": name, "train_runs": [m.run.id for m in runs], "seed": settings["seed"]}
    write_model(base, out, description, story)


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(
            catalogue=catalogue,
            motions=[Path(path) for path in snakemake.input.motions],
            campaign=Path(snakemake.input.campaign),
            file=str(snakemake.input.get("base") or ""),
            name=snakemake.wildcards.base.removesuffix("+") or "nominal",
            control=snakemake.wildcards.control,
            out=Path(snakemake.output.model),
            residual=snakemake.params.residual,
            settings=snakemake.params.settings,
        )
