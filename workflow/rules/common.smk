"""Names and helper functions that several rule files share."""

from pathlib import Path

from rovsim.application.sections import PredictorSettings, SimulationSections
from rovsim.diagnosis.settings import DiagnosisSettings

R = study.folder
F = f"{R}/folds/{{fold}}"
# scripts that read a model through their job do not import this themselves
MODEL_FILES = "rovsim.dynamics.model_file"


def code_of(script, *more, without=""):
    """Digest what a script imports, so that an edit re-runs what depends on it."""
    path = Path(workflow.basedir, "workflow", "scripts", f"{script}.py")
    return depends.code(path, *more, without=without)


def clean_runs():
    """Return files of every run, as motion and as poses before the filter."""
    return {
        "motions": expand(f"{R}/motions/{{run}}.npz", run=study.runs()),
        "stages": expand(f"{R}/resampled/{{run}}.npz", run=study.runs()),
    }


def model_files(wildcards):
    """Return a model's file; the baselines have none."""
    has_file = wildcards.model in models.with_files
    return [f"{R}/models/{wildcards.model}/model.yaml"] if has_file else []


def fold_runs():
    """Return files of every run as `clean_runs` does, with the splits of a fold."""
    return {
        kind: expand(f"{F}/{kind}/{{run}}.npz", run=study.runs(), allow_missing=True)
        for kind in ("motions", "stages")
    }
