"""Add the effects that were found to the nominal model."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.diagnosis.apply import added, read_diagnosis


def main(*, diagnosis: Path, out: Path) -> None:
    model, names = added(read_diagnosis(diagnosis), diagnosis, "nominal", None)
    model.write(out, provenance={"base": "nominal", "effects": names})


if __name__ == "__main__":
    with job(snakemake):
        main(diagnosis=Path(snakemake.input[0]), out=Path(snakemake.output[0]))
