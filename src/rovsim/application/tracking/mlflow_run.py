"""Log one MLflow run: its tags, parameters, metrics and files."""

import os
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Iterator, Mapping

import numpy as np
from filelock import FileLock

from rovsim.application.settings import TrackingSettings
from rovsim.application.tracking.ranking_view import (
    EXPERIMENT_TAGS,
    RANKING_METRIC,
    RELATIVE_METRIC,
    UI_ADDRESS,
    address,
    tags_of,
)
from rovsim.core.errors import BadInput
from rovsim.core.extras import require
from rovsim.core.files import appearing
from rovsim.core.horizons import OPEN_LOOP
from rovsim.results.base import ByAxis
from rovsim.results.comparison import Metrics, RunErrors

# with a server that does not answer: MLflow's own is four minutes for each call
SERVER_PATIENCE = {
    "MLFLOW_HTTP_REQUEST_MAX_RETRIES": "3",
    "MLFLOW_HTTP_REQUEST_TIMEOUT": "60",
}


@dataclass(frozen=True, kw_only=True)
class TrackedRun:
    """What is logged as one MLflow run.

    Attributes:
        experiment: name of the campaign.
        name: of the run.
        tags: model, residual and control.
        files: kept as artifacts.
        params: hyperparameters.
        scores: errors of the model, by run of the campaign.
        metrics: further numbers.
        parent: id of the MLflow run in which this one is nested.
    """

    experiment: str
    name: str
    tags: Mapping[str, str]
    files: Iterable[Path]
    params: Mapping[str, Any] = field(default_factory=dict)
    scores: Mapping[str, RunErrors] = field(default_factory=dict)
    metrics: Mapping[str, float] = field(default_factory=dict)
    parent: str | None = None


def track(settings: TrackingSettings, run: TrackedRun) -> str:
    """Log one run, and return its id.

    Args:
        settings: where MLflow keeps runs.
        run: what is logged.

    Raises:
        BadInput: MLflow cannot keep the run there.
    """
    with _mlflow_errors(settings.uri), FileLock(_lock(settings.uri)):
        client = _client(settings)
        number = _experiment(client, settings, run.experiment)
        tags = {**run.tags, "mlflow.runName": run.name}
        tags |= {"mlflow.parentRunId": run.parent} if run.parent else {}
        run_id = client.create_run(number, tags=tags).info.run_id
        try:
            _log(client, run_id, run.params, metrics_of(run.scores) | dict(run.metrics), run.files)
        except BaseException:
            client.set_terminated(run_id, "FAILED")
            raise
        client.set_terminated(run_id)
        return run_id


def ranking(errors: Mapping[str, float | None], model: str, base: str) -> dict[str, float]:
    """Return the error by which models are ranked, and its ratio to that of the base.

    Args:
        errors: error in windows of 2 s, by model.
        model: that is ranked.
        base: that it is compared with.

    Returns:
        Metrics by name; empty where one of the errors is unknown.
    """
    error, base_error = errors[model], errors[base]
    if error is None or not base_error:
        return {}
    return {RANKING_METRIC: error, RELATIVE_METRIC: error / base_error}


def metrics_of(scores: Mapping[str, RunErrors]) -> dict[str, float]:
    """Average errors over runs; metrics are named `split/horizon/quantity/axis`."""
    by_key: dict[str, list[float]] = {}
    for run in scores.values():
        for horizon in (OPEN_LOOP, *run.windows):
            metrics = run.at(horizon)
            for key, value in _flat(metrics) if metrics else ():
                if value is not None:
                    by_key.setdefault(f"{run.split}/{horizon}/{key}", []).append(value)
    return {key: float(np.mean(values)) for key, values in by_key.items()}


def _flat(metrics: Metrics) -> Iterable[tuple[str, float | None]]:
    """List numbers by name; those of axes as `quantity/axis`."""
    for quantity, value in metrics:
        if isinstance(value, ByAxis):
            yield from ((f"{quantity}/{axis}", v) for axis, v in value)
        else:
            yield quantity, value


def tell_ranking(settings: TrackingSettings, experiment: str) -> str:
    """Say where the models of a campaign are ranked: what to start, and which link to open."""
    with _mlflow_errors(settings.uri):
        number = _find_or_create_experiment(_client(settings), settings, experiment)
    if _local(settings.uri) is None:
        return f"Ranking of the models: {address(number, settings.uri.rstrip('/') + '/')}"
    return (
        f"Ranking of the models: mlflow ui --backend-store-uri {settings.uri}\n"
        f"  {address(number, UI_ADDRESS)}"
    )


def _log(client, run_id: str, params: Mapping, metrics: Mapping, files: Iterable[Path]) -> None:
    from mlflow.entities import Metric, Param

    entries = [Param(key, str(value)[:500]) for key, value in params.items()]
    client.log_batch(run_id, params=entries)
    batch = [Metric(key, value, 0, 0) for key, value in metrics.items()]
    for first in range(0, len(batch), 900):  # MLflow takes at most 1000 metrics a batch
        client.log_batch(run_id, metrics=batch[first : first + 900])
    for file in files:
        client.log_artifact(run_id, str(file))


@contextmanager
def _mlflow_errors(uri: str) -> Iterator[None]:
    """Turn MLflow's errors into one message.

    Raises:
        BadInput: MLflow cannot keep the run, or is not installed.
    """
    require("tracking", by="tracking.uri")
    for name, value in {"MLFLOW_DISABLE_TELEMETRY": "true", **SERVER_PATIENCE}.items():
        os.environ.setdefault(name, value)
    from mlflow.exceptions import MlflowException
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (MlflowException, SQLAlchemyError) as error:
        raise BadInput(
            f"MLflow cannot keep the run: {str(error).splitlines()[0]}",
            where=f"tracking.uri={uri}",
            expected="a local database (sqlite:///FILE) or a server that answers",
            remedy="Start the server, or set tracking.uri. What was computed is kept in its files.",
        ) from None


def _client(settings: TrackingSettings):
    import logging

    from mlflow.tracking import MlflowClient

    logging.getLogger("alembic").setLevel(logging.WARNING)
    logging.getLogger("mlflow").setLevel(logging.WARNING)
    if (path := _local(settings.uri)) and not path.exists():
        _create(path)
    return MlflowClient(tracking_uri=_absolute(settings.uri))


def _create(path: Path) -> None:
    """Create a local database, whole or not at all.

    MLflow makes its tables one by one. If it is killed half-way, no later start can use them.
    """
    from mlflow.store.tracking import DEFAULT_LOCAL_FILE_AND_ARTIFACT_PATH
    from mlflow.store.tracking.sqlalchemy_store import SqlAlchemyStore

    with appearing(path) as temporary:
        store = SqlAlchemyStore(f"sqlite:///{temporary}", DEFAULT_LOCAL_FILE_AND_ARTIFACT_PATH)
        store.engine.dispose()


def _local(uri: str) -> Path | None:
    """Return the file of a local database; None for a server."""
    prefix = "sqlite:///"
    return Path(uri.removeprefix(prefix)).absolute() if uri.startswith(prefix) else None


def _absolute(uri: str) -> str:
    """Give a local database its absolute path, as MLflow keeps connections open by this name."""
    path = _local(uri)
    return f"sqlite:///{path}" if path else uri


def _experiment(client, settings: TrackingSettings, name: str) -> str:
    """Return the number of an experiment, created if need be, with the tags of its ranking."""
    experiment_id = _find_or_create_experiment(client, settings, name)
    tags = client.get_experiment(experiment_id).tags
    for key, value in tags_of(experiment_id).items():
        if key not in tags:  # what a user has changed stays
            client.set_experiment_tag(experiment_id, key, value)
    return experiment_id


def _find_or_create_experiment(client, settings: TrackingSettings, name: str) -> str:
    experiment = client.get_experiment_by_name(name)
    if experiment is not None:
        return experiment.experiment_id
    local = _local(settings.uri) is not None
    place = Path(settings.artifacts, name).absolute().as_uri() if local else None
    from mlflow.exceptions import MlflowException

    try:
        return client.create_experiment(name, artifact_location=place, tags=EXPERIMENT_TAGS)
    except MlflowException:  # another machine was first: a file lock holds on one only
        experiment = client.get_experiment_by_name(name)
        if experiment is None:
            raise
        return experiment.experiment_id


def _lock(uri: str) -> Path:
    """Return the lock file: beside a local database; for a server, in the working folder."""
    path = _local(uri)
    place = path.with_suffix(".lock") if path else Path(".rovsim-tracking.lock")
    place.parent.mkdir(parents=True, exist_ok=True)
    return place
