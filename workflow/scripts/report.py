"""Write the report."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import read_json
from rovsim.dynamics.catalogue import Catalogue
from rovsim.reporting.html import page
from rovsim.reporting.report_data import ONCE, about


def main(
    *, campaign: str, contents: dict[str, Path], quality: dict[str, Path], figures: list[Path],
    provenance: dict, out: Path, catalogue: Catalogue,
) -> None:  # fmt: skip
    pictures = []
    for path in figures:
        name, _, run = (path.stem, "", "") if path.stem in ONCE else path.stem.partition("-")
        pictures.append(page.Picture.read(path, name, about(name, run)))
    found = {name: read_json(path) for name, path in contents.items()}
    reports = {run: read_json(path) for run, path in quality.items()}
    inputs = page.ReportInputs(
        campaign,
        quality=reports,
        pictures=pictures,
        provenance=provenance,
        catalogue=catalogue,
        **found,
    )
    page.write(out, inputs)


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(
            catalogue=catalogue,
            campaign=snakemake.params.campaign,
            contents={
                name: Path(str(snakemake.input[name]))
                for name in page.CONTENTS
                if snakemake.input[name]
            },
            quality=dict(
                zip(snakemake.params.runs, map(Path, snakemake.input.quality), strict=True)
            ),
            figures=[Path(path) for path in snakemake.input.figures],
            provenance=snakemake.params.provenance,
            out=Path(snakemake.output[0]),
        )
