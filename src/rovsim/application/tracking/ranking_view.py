"""How MLflow shows a campaign: as models, and as a ranking that a link opens.

MLflow keeps a view that a user shares as a tag of the experiment, under a key that is part of the
link (MLflow 3, "Share" on the page of runs). Here the key is `ranking`: all runs that have the
error by which models are ranked, the best first, with columns of model, residual and control.
"""

import json
from typing import Any

RANKED_BY = "windows_2s"
OF_BASE = f"{RANKED_BY}/of_base"
KEY = "ranking"
UI = "http://127.0.0.1:5000/"  # of `mlflow ui`, unless told otherwise
# Tag by which MLflow shows an experiment on its page for models, not on that for prompts.
SHOWN = {"mlflow.experimentKind": "custom_model_development"}
COLUMNS = (
    f"metrics.`{RANKED_BY}`",
    f"metrics.`{OF_BASE}`",
    "tags.`model`",
    "tags.`residual`",
    "tags.`control`",
)
VIEW: dict[str, Any] = {
    "searchFilter": f"metrics.{RANKED_BY} >= 0",
    "orderByKey": COLUMNS[0],
    "orderByAsc": True,
    "selectedColumns": COLUMNS,
}


def address(number: str, server: str = "") -> str:
    """Return the link to the ranking of an experiment, by the experiment's number."""
    return f"{server}#/experiments/{number}/runs?viewStateShareKey={KEY}"


def tags_of(number: str) -> dict[str, str]:
    """Return the tags of an experiment: its view, and a description with a link to it."""
    note = (
        f"[Ranking of the models]({address(number)}) by `{RANKED_BY}`, the 2 s error on test runs"
    )
    return SHOWN | {
        f"mlflow.sharedViewState.{KEY}": json.dumps(VIEW),
        "mlflow.note.content": f"{note}: lower is better.",
    }
