"""Log the study to MLflow: one parent run; in it one run a model, and the diagnosis."""

from pathlib import Path

from rovsim.application.settings import TrackingSettings
from rovsim.application.snakemake_job import job
from rovsim.application.tracking import track, track_diagnosis
from rovsim.core.files import read_json, read_yaml, write_json
from rovsim.core.schema import checked


def main(
    *, campaign: str, comparison: Path, ladder: Path, diagnosis: Path, models: list[Path],
    files: list[Path], tracking: dict, how: dict, out: Path,
) -> None:  # fmt: skip
    settings = checked(TrackingSettings, tracking, "conf")
    steps = {step["model"]: step["windows_2s"] for step in read_json(ladder)["steps"]}
    written = {path.parent.name: path for path in models}
    parent = track(
        settings, experiment=campaign, name="study", tags={"model": "study"}, params={},
        scores={}, files=files,
    )  # fmt: skip
    diagnosed = track_diagnosis(
        settings, campaign, "nominal", read_json(diagnosis), how, [diagnosis], parent
    )
    runs = {"study": parent, "diagnosis": diagnosed}
    for name, entry in read_json(comparison)["models"].items():
        runs[name] = track(
            settings, experiment=campaign, name=name, parent=parent, scores=entry["runs"],
            metrics={"windows_2s": steps[name]} if steps.get(name) is not None else {},
            **_described(name, written.get(name)),
        )  # fmt: skip
    write_json(out, runs)


def _described(name: str, path: Path | None) -> dict:
    """Tags, hyperparameters and files of one model."""
    content = read_yaml(path) if path else {}
    residual = content.get("residual") or {}
    base = content["provenance"]["base"] if residual else name
    tags = {"model": base, "residual": residual.get("kind", "none")}
    arrays = [path.with_name("residual.npz")] if residual else []
    return {
        "tags": tags | {"control": residual.get("control", "none")},
        "params": residual.get("settings", {}),
        "files": [*([path] if path else []), *arrays],
    }


if __name__ == "__main__":
    with job(snakemake):
        main(
            campaign=snakemake.params.campaign,
            comparison=Path(snakemake.input.comparison),
            ladder=Path(snakemake.input.ladder),
            diagnosis=Path(snakemake.input.diagnosis),
            models=[Path(path) for path in snakemake.input.models],
            files=[*map(Path, snakemake.input.figures), Path(snakemake.input.report)],
            tracking=snakemake.params.tracking,
            how=snakemake.params.diagnosis,
            out=Path(snakemake.output[0]),
        )
