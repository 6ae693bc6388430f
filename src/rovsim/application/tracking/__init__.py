"""MLflow: one experiment a campaign, one run a model or diagnosis. Written after results, unread.

Runs are written under a lock, one writer at a time, so parallel jobs never find a locked database.
"""

from rovsim.application.tracking.diagnosis import track_diagnosis
from rovsim.application.tracking.runs import ranking, tell_ranking, track

__all__ = ["ranking", "tell_ranking", "track", "track_diagnosis"]
