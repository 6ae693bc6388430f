"""Log the study to MLflow: a parent run, and in it a run for each model and the diagnosis."""

import json

from rovsim.application.settings import TrackingSettings
from rovsim.application.snakemake_job import job
from rovsim.application.tracking.study import StudyFiles, track_study
from rovsim.core.files import write_json

if __name__ == "__main__":
    with job(snakemake) as rule:
        runs = track_study(
            settings=rule.section(TrackingSettings),
            experiment=rule.params.experiment,
            files=StudyFiles(
                comparison=rule.path("comparison"),
                ladder=rule.path("ladder"),
                diagnosis=rule.path("diagnosis"),
                models=rule.paths("models"),
                kept=[*rule.paths("figures"), rule.path("report")],
            ),
            diagnosing=json.loads(rule.params.diagnosis),
        )
        write_json(rule.output(), runs)
