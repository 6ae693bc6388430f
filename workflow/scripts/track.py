"""Log the study to MLflow: one parent run, one run a model."""

from pathlib import Path

from rovsim.config import TrackingSettings
from rovsim.files import read_json, read_yaml, write_json
from rovsim.jobs import job
from rovsim.strict import checked
from rovsim.tracking import track


def main(
    *, campaign: str, comparison: Path, ladder: Path, models: list[Path], files: list[Path],
    tracking: dict, out: Path,
) -> None:  # fmt: skip
    settings = checked(TrackingSettings, tracking, "conf")
    steps = {step["model"]: step["windows_2s"] for step in read_json(ladder)["steps"]}
    trained = {path.parent.name: path for path in models}
    parent = track(
        settings, experiment=campaign, name="study", tags={"model": "study"}, params={},
        scores={}, files=files,
    )  # fmt: skip
    runs = {"study": parent}
    for name, entry in read_json(comparison)["models"].items():
        path = trained.get(name)
        residual = read_yaml(path)["residual"] if path else {}
        tags = {"model": "nominal" if path else name, "residual": residual.get("kind", "none")}
        runs[name] = track(
            settings, experiment=campaign, name=name, parent=parent, scores=entry["runs"],
            tags=tags | {"control": residual.get("control", "none")},
            params=residual.get("settings", {}),
            files=[path, path.with_name("residual.npz")] if path else [],
            metrics={"windows_2s": steps[name]} if steps.get(name) is not None else {},
        )  # fmt: skip
    write_json(out, runs)


if __name__ == "__main__":
    with job(snakemake):
        main(
            campaign=snakemake.params.campaign,
            comparison=Path(snakemake.input.comparison),
            ladder=Path(snakemake.input.ladder),
            models=[Path(path) for path in snakemake.input.models],
            files=[*map(Path, snakemake.input.figures), Path(snakemake.input.report)],
            tracking=snakemake.params.tracking,
            out=Path(snakemake.output[0]),
        )
