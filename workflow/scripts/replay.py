"""Replay all runs through one model."""

from rovsim.application.sections import SimulationSettings
from rovsim.application.snakemake_job import job
from rovsim.simulation.replay import replay

if __name__ == "__main__":
    with job(snakemake) as rule:
        settings, model = rule.section(SimulationSettings), rule.model(rule.wildcards.model)
        for k, motion in enumerate(rule.motions()):
            replay(model, motion, settings.signals, settings.replay).write(rule.output(k))
