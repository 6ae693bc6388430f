"""Write the tables."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import read_json
from rovsim.reporting.tables import errors_table, ladder_table

QUANTITIES = ("velocity_rmse", "velocity_mae", "acceleration_rmse")


def main(*, comparison: Path, ladder: Path, folder: Path) -> None:
    ladder_table(read_json(ladder)).write(folder, "ladder")
    for quantity in QUANTITIES:
        errors_table(read_json(comparison), "2", "test", quantity).write(folder, quantity)


if __name__ == "__main__":
    with job(snakemake):
        main(
            comparison=Path(snakemake.input.comparison),
            ladder=Path(snakemake.input.ladder),
            folder=Path(snakemake.params.folder),
        )
