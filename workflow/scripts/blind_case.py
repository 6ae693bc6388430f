"""Fly a case of the blind benchmark, and let every method answer it."""

import os

os.environ["NUMBA_NUM_THREADS"] = "1"  # before Numba is imported: seconds are those of one core

from rovsim.application.settings import BlindSettings
from rovsim.application.snakemake_job import job
from rovsim.benchmarks.blind.run import Benchmark, run

if __name__ == "__main__":
    with job(snakemake) as rule:
        benchmark = Benchmark.of(rule.section(BlindSettings), rule.params.out)
        run(benchmark.only(rule.wildcards.case).pending())
