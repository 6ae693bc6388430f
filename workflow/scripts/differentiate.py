"""Derive velocities and accelerations; no row of an unusable run counts."""

from rovsim.application.pipeline.motion import derive_motion
from rovsim.application.snakemake_job import job
from rovsim.measurement.signals.chain import SignalSettings, read_stage
from rovsim.results.quality import Quality

if __name__ == "__main__":
    with job(snakemake) as rule:
        derive_motion(
            poses=read_stage(rule.path("poses")),
            quality=Quality.read(rule.path("quality")),
            settings=rule.section(SignalSettings),
        ).write(rule.output())
