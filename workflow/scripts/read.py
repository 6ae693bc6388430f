"""Read one raw export."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import write_json
from rovsim.core.schema import checked
from rovsim.measurement.campaign import load_campaign
from rovsim.measurement.quality_report import quality_of
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings


def main(*, campaign: Path, run: str, outliers: dict, recording: Path, quality: Path) -> None:
    found, anomalies = read_run(load_campaign(campaign), run)
    settings = checked(SignalSettings, outliers, "conf")
    write_json(quality, quality_of(found, anomalies, settings.outliers))
    found.write(recording)


if __name__ == "__main__":
    with job(snakemake):
        main(
            campaign=Path(snakemake.params.campaign),
            run=snakemake.wildcards.run,
            outliers=snakemake.params.outliers,
            recording=Path(snakemake.output.recording),
            quality=Path(snakemake.output.quality),
        )
