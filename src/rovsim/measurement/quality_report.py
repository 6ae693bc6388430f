"""The quality report of one run, outliers included."""

from typing import Any

from rovsim.measurement.recording import Anomalies, quality_report
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.outliers import Outliers, find_outliers


def quality_of(recording: Recording, anomalies: Anomalies, settings: Outliers) -> dict[str, Any]:
    """Plain report; outliers of binned velocities are not looked for."""
    if recording.nu is not None:
        return quality_report(recording, anomalies)
    return quality_report(recording, anomalies, int(find_outliers(recording, settings).sum()))
