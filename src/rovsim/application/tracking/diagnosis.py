"""Log a diagnosis as an MLflow run, with a nested run for every step of its ladder."""

from pathlib import Path
from typing import Any, Iterable, Mapping

from rovsim.application.settings import TrackingSettings
from rovsim.application.tracking.mlflow_run import TrackedRun, track
from rovsim.core.mappings import leaves
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.ladder import LadderStep

STEP_FILES = ("diagnosis", "ladder")  # files, without their endings, that say what a step is


def track_diagnosis(
    settings: TrackingSettings,
    experiment: str,
    base: str,
    diagnosis: Diagnosis,
    params: Mapping[str, Any],
    files: Iterable[Path],
    parent: str | None = None,
) -> dict[str, str]:
    """Log a diagnosis, and nested in it every step of its ladder.

    Args:
        settings: where MLflow keeps runs.
        experiment: name of the campaign.
        base: name of the model that was diagnosed.
        diagnosis: what is logged.
        params: settings of the diagnosis, nested plain values.
        files: kept as artifacts; the diagnosis itself and the figure of the ladder also with every
            step.
        parent: id of the run in which this one is nested.

    Returns:
        Ids of the runs, by name: `diagnosis`, and each step's model.
    """
    files = list(files)
    selected = "+".join(effect.effect for effect in diagnosis.selected) or "none"
    tags = {"model": base, "verdict": diagnosis.verdict, "selected": selected}
    parent_run = TrackedRun(
        experiment=experiment,
        name="diagnosis",
        tags=tags,
        params=leaves(params),
        files=files,
        parent=parent,
        metrics=diagnosis_metrics(diagnosis),
    )
    run_id = track(settings, parent_run)
    runs = {"diagnosis": run_id}
    for step in diagnosis.ladder.steps:
        of_step = TrackedRun(
            experiment=experiment,
            name=step.model,
            parent=run_id,
            tags={"model": step.model, "residual": "none", "control": "none"},
            files=[path for path in files if path.stem in STEP_FILES],
            metrics=step_metrics(step),
        )
        runs[step.model] = track(settings, of_step)
    return runs


def diagnosis_metrics(diagnosis: Diagnosis) -> dict[str, float]:
    """Return the errors of a diagnosis; of each selected effect its worth and fitted values."""
    metrics = {f"error/{name}": value for name, value in diagnosis.error}
    for selected in diagnosis.selected:
        name = selected.effect
        metrics[f"{name}/error_reduction"] = selected.error_reduction
        metrics[f"{name}/probability"] = selected.probability
        for parameter, fitted in selected.parameters.items():
            metrics[f"{name}/{parameter}"] = fitted.value
            metrics[f"{name}/{parameter}/std"] = fitted.std
    return {name: value for name, value in metrics.items() if value is not None}


def step_metrics(step: LadderStep) -> dict[str, float]:
    """Return the numbers of one step of a ladder, named as those of a comparison."""
    metrics = {"windows_2s": step.windows_2s}
    for quantity in ("acceleration_rmse", "velocity_mae"):
        metrics |= {f"test/2/{quantity}/{axis}": v for axis, v in getattr(step, quantity)}
    return {name: value for name, value in metrics.items() if value is not None}
