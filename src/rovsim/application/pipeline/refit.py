"""Refit the nominal model's own parameters to the train runs."""

from pathlib import Path

from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import write_model
from rovsim.estimation.observer.train_runs import prepare_train
from rovsim.estimation.refit import refit_nominal
from rovsim.measurement.runs import Runs


def refit(
    runs: Runs, base: Model, settings: DiagnosisSettings, catalogue: Catalogue, out: Path
) -> Model:
    """Refit a model's own parameters to the train runs, and write it as a model file.

    The fit uses the same parts of the train runs as the diagnosis.
    """
    seconds = settings.search.most_seconds
    train = prepare_train(runs, settings.replay, catalogue, base.body.free, seconds).runs
    model = refit_nominal(base, train)
    story = {
        "base": base.name,
        "train_runs": list(dict.fromkeys(run.motion.run.id for run in train)),
    }
    write_model(model, out, provenance=story)
    return model
