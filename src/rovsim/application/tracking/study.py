"""Log a study as an MLflow run, with nested runs for every model and the diagnosis."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence

from rovsim.application.settings import TrackingSettings
from rovsim.application.tracking.diagnosis import track_diagnosis
from rovsim.application.tracking.mlflow_run import TrackedRun, track
from rovsim.application.tracking.ranking_view import RANKING_METRIC
from rovsim.core.model_names import NOMINAL
from rovsim.core.yaml_files import read_yaml
from rovsim.results.comparison import Comparison
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.ladder import Ladder

MODEL_FIGURES = ("ladder", "error_by_axis", "error_growth")  # figures that show each of them


@dataclass(frozen=True)
class StudyFiles:
    """Files that a study wrote.

    Attributes:
        comparison: errors of all models.
        ladder: of models.
        diagnosis: of the nominal model.
        models: model files, of the models that have one.
        figures: of the study.
        report: of the study.
    """

    comparison: Path
    ladder: Path
    diagnosis: Path
    models: Sequence[Path]
    figures: Sequence[Path]
    report: Path


def track_study(
    settings: TrackingSettings, experiment: str, files: StudyFiles, diagnosing: Mapping[str, Any]
) -> dict[str, Any]:
    """Log a study.

    Args:
        settings: where MLflow keeps runs.
        experiment: name of the campaign.
        files: that are logged.
        diagnosing: settings of the diagnosis, nested plain values.

    Returns:
        Ids of the runs by name; under `diagnosis` those of its run and its steps, by name.
    """
    ladder, diagnosis = Ladder.read(files.ladder), Diagnosis.read(files.diagnosis)
    errors = ladder.errors
    by_model = {path.parent.name: path for path in files.models}
    figures = [path for path in files.figures if path.stem in MODEL_FIGURES]
    of_steps = [files.diagnosis, *(path for path in figures if path.stem == "ladder")]
    study = TrackedRun(
        experiment=experiment,
        name="study",
        tags={"model": "study"},
        files=[*files.figures, files.report],
    )
    parent = track(settings, study)
    diagnosed = track_diagnosis(
        settings, experiment, NOMINAL, diagnosis, diagnosing, of_steps, parent
    )
    runs: dict[str, Any] = {"study": parent, "diagnosis": diagnosed}
    for name, entry in Comparison.read(files.comparison).models.items():
        of_model = TrackedRun(
            experiment=experiment,
            name=name,
            parent=parent,
            scores=entry.runs,
            metrics={RANKING_METRIC: errors[name]} if name in errors else {},
            **_described(name, by_model.get(name), figures),
        )
        runs[name] = track(settings, of_model)
    return runs


def _described(name: str, path: Path | None, figures: Sequence[Path]) -> dict[str, Any]:
    """Return tags, hyperparameters and files of one model.

    Args:
        name: of the model.
        path: of its file, if it has one.
        figures: that are kept with every model.
    """
    content = read_yaml(path) if path else {}
    residual, story = content.get("residual") or {}, content.get("provenance") or {}
    base = story["base"] if residual else name
    tags = {"model": base, "residual": residual.get("kind", "none")}
    arrays = [path.with_name(residual["file"])] if path and residual else []
    return {
        "tags": tags | {"control": residual.get("control", "none")},
        "params": _hyperparameters(residual, story["seed"]) if residual else {},
        "files": [*([path] if path else []), *arrays, *figures],
    }


def _hyperparameters(residual: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Return hyperparameters of a trained residual, under the keys that `rovsim train` logs."""
    features = {"blocks": [*residual["features"]], "scaling": residual["scaling"]}
    hyperparameters = {"kind": residual["kind"], **residual["settings"], "features": features}
    return hyperparameters | {"seed": seed}
