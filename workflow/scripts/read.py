"""Read one raw export."""

from pathlib import Path

from rovsim.application.pipeline.reading import read_recording
from rovsim.application.snakemake_job import job
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.signals.outliers import OutlierSettings

if __name__ == "__main__":
    with job(snakemake) as rule:
        recording, quality = read_recording(
            campaign=load_campaign(Path(rule.params.campaign)),
            run=rule.wildcards.run,
            outliers=rule.section(OutlierSettings).outliers,
        )
        quality.write(rule.output("quality"))
        recording.write(rule.output("recording"))
