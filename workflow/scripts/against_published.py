"""Compare the errors on held-out runs with those that others published for the same runs."""

from rovsim.application.pipeline.held_out import compare_with_published
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        compare_with_published(
            published=rule.path("published"),
            comparisons=rule.paths("comparisons"),
            motions=rule.motions(),
            out=rule.output("published_errors"),
            tables=rule.output("csv").parent,
        )
