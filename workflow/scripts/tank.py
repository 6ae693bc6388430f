"""Fly the synthetic campaign."""

from rovsim.application.snakemake_job import job
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings

if __name__ == "__main__":
    with job(snakemake) as rule:
        make_campaign(rule.section(TankSettings), rule.output().parent, rule.catalogue)
