"""Time library call and exported predictor of every trained model."""

from rovsim.application.pipeline.training import time_predictors
from rovsim.application.sections import PredictorSettings
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        (motion,) = rule.motions("motion")
        found = time_predictors(
            models=rule.models(),
            base=rule.model("nominal"),
            motion=motion,
            settings=rule.section(PredictorSettings),
        )
        found.write(rule.output())
