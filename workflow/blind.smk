"""The blind benchmark, case by case, on the cores of a machine or over a cluster.

snakemake -s workflow/blind.smk --cores 2 [--config overrides="blind.suite=standard"]

Cases that this code has answered before are left out. In the end `rovsim blind` scores all.
"""

import sys

from rovsim.application.study.snakemake_config import SnakemakeConfig
from rovsim.benchmarks.blind.run import Benchmark, file_name
from rovsim.core.errors import RovsimError

try:
    snakemake_config = SnakemakeConfig(config, keys=("overrides",))
    snakemake_config.check()
    words, settings = snakemake_config.overrides, snakemake_config.settings
    benchmark = Benchmark.of(settings.blind, settings.out)
    jobs = benchmark.pending()
except RovsimError as error:
    print(f"rovsim: {error}", file=sys.stderr)
    sys.exit(2)

ASKED = f"{benchmark.out}/.asked/{{case}}.{{mark}}"  # mark: digest of what the answers depend on


wildcard_constraints:
    mark="[0-9a-f]+",


localrules:
    score,


rule score:
    "Score every answer, and write the tables."
    input:
        [ASKED.format(case=file_name(job.case), mark=job.mark) for job in jobs],
    params:
        python=sys.executable,
        words=[*words, f"out={benchmark.out}"],
    shell:
        "{params.python:q} -m rovsim blind {params.words:q}"


rule case:
    "Fly a case, and let every method answer it."
    output:
        temp(touch(ASKED)),
    log:
        f"{benchmark.out}/logs/{{case}}.{{mark}}.log",
    resources:
        mem_mb=2000,
    params:
        settings=settings.blind.model_dump_json(),
        out=str(benchmark.out),
    script:
        "scripts/blind_case.py"
