"""Bring all scores together."""

from pathlib import Path

from rovsim.application.snakemake_job import job
from rovsim.core.files import read_json, write_json
from rovsim.evaluation.error_conditions import merged
from rovsim.evaluation.ladder import step, with_diagnosis
from rovsim.evaluation.scores import comparison, growth
from rovsim.measurement.signals.motion import Motion
from rovsim.simulation.prediction import Replay


def main(
    *, scores: list[Path], replays: list[Path], motions: list[Path], models: list[str],
    searches: list[Path], diagnosis: Path, out: dict[str, Path],
) -> None:  # fmt: skip
    measured = [Motion.read(path) for path in motions]
    steps, curves = [], {}
    for k, name in enumerate(models):
        runs = [Replay.read(p) for p in replays[k * len(measured) : (k + 1) * len(measured)]]
        steps.append(step(name, measured, runs))
        curves[name] = growth(measured, runs)
    write_json(out["where"], merged([read_json(path) for path in searches]))
    write_json(out["growth"], {"models": curves})
    found = read_json(diagnosis)["ladder"]["steps"]
    write_json(out["ladder"], with_diagnosis(steps, found))
    write_json(out["comparison"], comparison(one for path in scores for one in read_json(path)))


if __name__ == "__main__":
    with job(snakemake):
        main(
            scores=[Path(path) for path in snakemake.input.scores],
            replays=[Path(path) for path in snakemake.input.replays],
            motions=[Path(path) for path in snakemake.input.motions],
            searches=[Path(path) for path in snakemake.input.searches],
            diagnosis=Path(snakemake.input.diagnosis),
            models=list(snakemake.params.models),
            out={name: Path(path) for name, path in snakemake.output.items()},
        )
