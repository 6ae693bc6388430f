"""Judge the quality of one recording."""

from rovsim.application.pipeline.quality import judge_recording
from rovsim.application.snakemake_job import job
from rovsim.measurement.recording import Anomalies, Recording
from rovsim.measurement.signals.outliers import OutlierSettings

if __name__ == "__main__":
    with job(snakemake) as rule:
        judge_recording(
            campaign=rule.campaign,
            recording=Recording.read(rule.path("recording")),
            anomalies=Anomalies.read(rule.path("anomalies")),
            outliers=rule.section(OutlierSettings).outliers,
        ).write(rule.output())
