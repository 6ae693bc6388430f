"""Put the poses of one run on a uniform clock."""

from rovsim.application.snakemake_job import job
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.chain import SignalSettings, resampled

if __name__ == "__main__":
    with job(snakemake) as rule:
        resampled(Recording.read(rule.path("recording")), rule.section(SignalSettings)).write(
            rule.output()
        )
