"""Read one raw export, and assess its quality."""

from pathlib import Path

from rovsim.application.pipeline.reading import judge_recording, read_recording
from rovsim.application.snakemake_job import job
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.signals.outliers import OutlierSettings

if __name__ == "__main__":
    with job(snakemake) as rule:
        campaign = load_campaign(Path(rule.params.campaign))
        recording, anomalies = read_recording(campaign, run=rule.wildcards.run)
        judge_recording(
            campaign, recording, anomalies, outliers=rule.section(OutlierSettings).outliers
        ).write(rule.output("quality"))
        recording.write(rule.output("recording"))
