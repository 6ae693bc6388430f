"""Log the study to MLflow: a parent run, and in it a run for each model and the diagnosis."""

from rovsim.application.settings import TrackingSettings
from rovsim.application.snakemake_job import job
from rovsim.application.tracking.study import StudyFiles, track_study
from rovsim.core.files import write_json

if __name__ == "__main__":
    with job(snakemake) as rule:
        files = StudyFiles(
            comparison=rule.path("comparison"),
            ladder=rule.path("ladder"),
            diagnosis=rule.path("diagnosis"),
            models=rule.paths("models"),
            figures=rule.paths("figures"),
            report=rule.path("report"),
        )
        runs = track_study(
            settings=rule.section(TrackingSettings),
            experiment=rule.params.experiment,
            files=files,
            diagnosing=rule.params.diagnosing,
        )
        write_json(rule.output(), runs)
