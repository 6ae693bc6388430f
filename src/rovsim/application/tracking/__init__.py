"""MLflow: one experiment a campaign, one run a model or diagnosis. Written after results, unread.

Runs are written under a lock, one writer at a time, so parallel jobs never find a locked database.

mlflow_run    one MLflow run: its tags, parameters, metrics and files
study         a study as MLflow runs
diagnosis     a diagnosis as MLflow runs
ranking_view  how MLflow shows a campaign
"""

from rovsim.application.tracking.diagnosis import track_diagnosis
from rovsim.application.tracking.mlflow_run import TrackedRun, ranking, tell_ranking, track

__all__ = ["TrackedRun", "ranking", "tell_ranking", "track", "track_diagnosis"]
