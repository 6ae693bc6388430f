"""The nominal model with its own parameters fitted to the train runs."""

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
    """Refit a model's own parameters on the train runs, and write it as a model file.

    It looks at those parts of the train runs that the diagnosis looks at.
    """
    most = settings.search.most_seconds
    train = prepare_train(runs, settings.replay, catalogue, base.body.free, most).runs
    model = refit_nominal(base, train)
    story = {
        "base": base.name,
        "train_runs": list(dict.fromkeys(one.motion.run.id for one in train)),
    }
    write_model(model, out, provenance=story)
    return model
