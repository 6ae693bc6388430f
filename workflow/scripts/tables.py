"""Write the tables of the study."""

from rovsim.application.pipeline.study_tables import write_tables
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        write_tables(
            comparison=rule.path("comparison"),
            ladder=rule.path("ladder"),
            folder=rule.output().parent,
        )
