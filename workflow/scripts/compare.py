"""Bring all scores together."""

from rovsim.application.pipeline.summary import summarize
from rovsim.application.snakemake_job import job
from rovsim.core.files import read_json

if __name__ == "__main__":
    with job(snakemake) as rule:
        summarize(
            motions=rule.motions(),
            replays=rule.replays(),
            scores=[one for path in rule.paths("scores") for one in read_json(path)],
            searches=[read_json(path) for path in rule.paths("searches")],
            diagnosis=read_json(rule.path("diagnosis")),
            out=rule.output("comparison").parent,
        )
