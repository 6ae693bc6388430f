"""Write the scores, the ladder, the growth of errors and the error conditions of all models."""

from rovsim.application.pipeline.summary import summarize
from rovsim.application.snakemake_job import job
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import ErrorConditions

if __name__ == "__main__":
    with job(snakemake) as rule:
        summarize(
            motions=rule.motions(),
            replays=rule.replays(),
            searches=[ErrorConditions.read(path) for path in rule.paths("searches")],
            diagnosis=Diagnosis.read(rule.path("diagnosis")),
            out=rule.output("comparison").parent,
        )
