"""What is tracked: a database that is whole, whoever is killed."""

import pytest
from mlflow.store.tracking import sqlalchemy_store
from mlflow.tracking import MlflowClient

from rovsim.application.settings import TrackingSettings
from rovsim.application.tracking.runs import track


def tracked(name):
    settings = TrackingSettings(uri="sqlite:///results/mlflow.db", artifacts="results/mlflow")
    track(settings, experiment="tank", name=name, tags={}, params={"k": 5}, scores={}, files=[])
    return settings


def test_a_database_that_was_being_made_is_made_anew(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def killed(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as half:
        half.setattr(sqlalchemy_store.SqlAlchemyStore, "__init__", killed)
        with pytest.raises(KeyboardInterrupt):
            tracked("first")
    assert not (tmp_path / "results" / "mlflow.db").exists()
    settings = tracked("second")
    client = MlflowClient(tracking_uri=f"sqlite:///{tmp_path / 'results' / 'mlflow.db'}")
    experiment = client.get_experiment_by_name("tank")
    (run,) = client.search_runs([experiment.experiment_id])
    assert (run.info.run_name, run.data.params) == ("second", {"k": "5"})
    assert settings.artifacts in experiment.artifact_location
