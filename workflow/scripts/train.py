"""Train one residual on the train runs of one control."""

from rovsim.application.pipeline.training import train
from rovsim.application.sections import TrainingSettings
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        train(
            motions=rule.motions(),
            base=rule.model(rule.wildcards.base.removesuffix("+") or "nominal"),
            settings=rule.section(TrainingSettings),
            catalogue=rule.catalogue,
            out=rule.output("model"),
            story={},
        )
