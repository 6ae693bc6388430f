"""Replay and score the held-out run with every model of its fold."""

from rovsim.application.pipeline.held_out import score_held_out
from rovsim.application.sections import SimulationSections
from rovsim.application.snakemake_job import job
from rovsim.dynamics.model import BASELINES

if __name__ == "__main__":
    with job(snakemake) as rule:
        (motion,) = rule.motions("motion")
        found = score_held_out(
            models=[*map(rule.model, BASELINES), *rule.models()],
            motion=motion,
            settings=rule.section(SimulationSections),
        )
        found.write(rule.output())
