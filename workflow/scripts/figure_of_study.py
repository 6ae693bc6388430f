"""Draw one figure of the study."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import read_json
from rovsim.reporting.figures import kind
from rovsim.reporting.figures.style import save
from rovsim.reporting.report_data import Evidence, arguments


def main(*, figure: str, contents: dict[str, Path], quality: dict[str, Path], out: Path) -> None:
    found = {name: read_json(path) for name, path in contents.items()}
    reports = {run: read_json(path) for run, path in quality.items()}
    evidence = Evidence({}, {}, quality=reports, **found)
    save(kind(figure).draw(**arguments(figure, evidence)), out.parent, out.stem)


if __name__ == "__main__":
    with job(snakemake):
        main(
            figure=snakemake.params.figure,
            contents={
                name: Path(str(path))
                for name, path in snakemake.input.items()
                if path and name != "quality"
            },
            quality=dict(
                zip(snakemake.params.runs, map(Path, snakemake.input.quality), strict=True)
            ),
            out=Path(snakemake.output.png),
        )
