"""Write the report of the study."""

from rovsim.application.pipeline.study_report import write_report
from rovsim.application.snakemake_job import job
from rovsim.reporting.report_data import STUDY_RESULTS

if __name__ == "__main__":
    with job(snakemake) as rule:
        write_report(
            name=rule.params.name,
            contents=rule.contents(*STUDY_RESULTS),
            quality={path.stem: path for path in rule.paths("quality")},
            figures=rule.paths("figures"),
            given=rule.params.given,
            catalogue=rule.catalogue,
            out=rule.output(),
        )
