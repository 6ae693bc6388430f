"""Read one raw export."""

from rovsim.application.pipeline.recorded_run import read_recording
from rovsim.application.snakemake_job import job

if __name__ == "__main__":
    with job(snakemake) as rule:
        recording, anomalies = read_recording(rule.campaign, rule.wildcards.run)
        anomalies.write(rule.output("anomalies"))
        recording.write(rule.output("recording"))
