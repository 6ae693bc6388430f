"""Replay one run through one model."""

from rovsim.application.sections import SimulationSettings
from rovsim.application.snakemake_job import job
from rovsim.simulation.replay import replay

if __name__ == "__main__":
    with job(snakemake) as rule:
        (motion,) = rule.motions("motion")
        settings = rule.section(SimulationSettings)
        replay(rule.model(rule.wildcards.model), motion, settings.signals, settings.replay).write(
            rule.output()
        )
