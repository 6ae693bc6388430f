"""What several chapters of the workflow name alike."""

from pathlib import Path

from rovsim.application.sections import PredictorSettings, SimulationSections
from rovsim.diagnosis.settings import DiagnosisSettings

R = study.folder
F = f"{R}/folds/{{fold}}"


def code_of(script, *more, without=""):
    """Digest of what a script imports: an edit re-runs what it touches."""
    path = Path(workflow.basedir, "workflow", "scripts", f"{script}.py")
    return depends.code(path, *more, without=without)


def clean_runs():
    """Every run as a motion, and as poses before the filter."""
    return {
        "motions": expand(f"{R}/motions/{{run}}.npz", run=study.runs()),
        "stages": expand(f"{R}/resampled/{{run}}.npz", run=study.runs()),
    }


def model_files(wildcards):
    """A model's file; the baselines have none."""
    written = wildcards.model in models.with_files
    return [f"{R}/models/{wildcards.model}/model.yaml"] if written else []


def fold_runs():
    """Every run of a fold, as motion and as poses before the filter, its split changed."""
    return {
        kind: expand(f"{F}/{kind}/{{run}}.npz", run=study.runs(), allow_missing=True)
        for kind in ("motions", "stages")
    }
