"""Set the folds beside what others published for the same runs."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import read_json, write_json
from rovsim.evaluation.held_out.published_errors import against, demanded, read_published
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.tables import published_errors_table


def main(
    *, comparisons: dict[str, Path], motions: dict[str, Path], published: Path, out: Path,
    tables: Path,
) -> None:  # fmt: skip
    folds = {run: read_json(path) for run, path in comparisons.items()}
    moved = {run: demanded(Motion.read(path).commands) for run, path in motions.items()}
    found = against(read_published(published), folds, moved)
    published_errors_table(found).write(tables, "published_errors")
    write_json(out, found)


if __name__ == "__main__":
    with job(snakemake):
        runs = snakemake.params.runs
        main(
            comparisons=dict(zip(runs, map(Path, snakemake.input.comparisons), strict=True)),
            motions=dict(zip(runs, map(Path, snakemake.input.motions), strict=True)),
            published=Path(snakemake.input.published),
            out=Path(snakemake.output.marks),
            tables=Path(snakemake.output.csv).parent,
        )
