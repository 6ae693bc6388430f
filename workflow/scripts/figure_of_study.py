"""Draw one figure of the study."""

from rovsim.application.pipeline.drawing import draw_study
from rovsim.application.snakemake_job import job
from rovsim.reporting.report_data import STUDY_RESULTS

if __name__ == "__main__":
    with job(snakemake) as rule:
        draw_study(
            figure=rule.params.figure,
            contents=rule.contents(*STUDY_RESULTS),
            quality={path.stem: path for path in rule.paths("quality")},
            out=rule.output("png"),
        )
