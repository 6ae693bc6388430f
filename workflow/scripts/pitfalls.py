"""Repeat the mistakes of the thesis' public code, on each held-out run."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import write_json
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model_file import read_model
from rovsim.evaluation.held_out.pitfalls import SCHEMA, measure_pitfalls
from rovsim.learning.learner import learner_settings
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.settings import rule_settings


def main(
    *, motions: list[Path], models: list[Path], out: Path, learners: dict, settings: dict,
    catalogue: Catalogue,
) -> None:  # fmt: skip
    """`models`: the effects found while that run was held out."""
    runs = [Motion.read(path) for path in motions]
    known = {kind: learner_settings(given, "conf/residual") for kind, given in learners.items()}
    signals, how = rule_settings(settings)
    found = {
        test.run.id: measure_pitfalls(
            read_model(path, catalogue),
            [r for r in runs if r is not test],
            test,
            known,
            signals,
            how,
        )
        for test, path in zip(runs, models, strict=True)
    }
    write_json(out, {"schema": SCHEMA, "runs": found})


if __name__ == "__main__":
    with job(snakemake) as catalogue:
        main(
            catalogue=catalogue,
            motions=[Path(path) for path in snakemake.input.motions],
            models=[Path(path) for path in snakemake.input.models],
            out=Path(snakemake.output[0]),
            learners=snakemake.params.learners,
            settings=snakemake.params.settings,
        )
