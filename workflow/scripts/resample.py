"""Put poses on a uniform clock."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.schema import checked
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.chain import SignalSettings, resampled


def main(*, source: Path, out: Path, signals: dict) -> None:
    resampled(Recording.read(source), checked(SignalSettings, signals, "conf")).write(out)


if __name__ == "__main__":
    with job(snakemake):
        main(
            source=Path(snakemake.input[0]),
            out=Path(snakemake.output[0]),
            signals=snakemake.params.signals,
        )
