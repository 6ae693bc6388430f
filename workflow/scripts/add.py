"""Add the effects that were found to the nominal model."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.diagnosis.apply import added, read_diagnosis
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model_file import write_model


def main(*, diagnosis: Path, out: Path, catalogue: Catalogue) -> None:
    model, names = added(read_diagnosis(diagnosis), diagnosis, "nominal", None, catalogue)
    write_model(model, out, provenance={"base": "nominal", "effects": names})


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(diagnosis=Path(snakemake.input[0]), out=Path(snakemake.output[0]), catalogue=catalogue)
