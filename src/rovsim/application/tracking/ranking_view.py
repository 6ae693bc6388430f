"""How MLflow shows a campaign: as models, and as a ranking that a link opens.

MLflow keeps a view that a user shares as a tag of the experiment, under a key that is part of the
link (MLflow 3, "Share" on the page of runs). Here the key is `ranking`: all runs that have the
error by which models are ranked, the best first, with columns of model, residual and control.
"""

import json
from typing import Any

RANKING_METRIC = "windows_2s"
RELATIVE_METRIC = f"{RANKING_METRIC}/of_base"
VIEW_KEY = "ranking"
UI_ADDRESS = "http://127.0.0.1:5000/"  # of `mlflow ui`, unless told otherwise
# Tag by which MLflow shows an experiment on its page for models, not on that for prompts.
EXPERIMENT_TAGS = {"mlflow.experimentKind": "custom_model_development"}
COLUMNS = (
    f"metrics.`{RANKING_METRIC}`",
    f"metrics.`{RELATIVE_METRIC}`",
    "tags.`model`",
    "tags.`residual`",
    "tags.`control`",
)
VIEW: dict[str, Any] = {
    "searchFilter": f"metrics.{RANKING_METRIC} >= 0",
    "orderByKey": COLUMNS[0],
    "orderByAsc": True,
    "selectedColumns": COLUMNS,
}


def address(number: str, server: str = "") -> str:
    """Return the link to the ranking of an experiment, by the experiment's number."""
    return f"{server}#/experiments/{number}/runs?viewStateShareKey={VIEW_KEY}"


def tags_of(number: str) -> dict[str, str]:
    """Return the tags of an experiment: its view, and a description with a link to it."""
    note = (
        f"[Ranking of the models]({address(number)}) by `{RANKING_METRIC}`, the 2 s error on test "
        "runs"
    )
    return EXPERIMENT_TAGS | {
        f"mlflow.sharedViewState.{VIEW_KEY}": json.dumps(VIEW),
        "mlflow.note.content": f"{note}: lower is better.",
    }
