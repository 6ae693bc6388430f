"""The quality report of one run, outliers included."""

from rovsim.measurement.recording import Anomalies, assess
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.outliers import Outliers, find_outliers
from rovsim.results.quality import Quality


def report_quality(recording: Recording, anomalies: Anomalies, settings: Outliers) -> Quality:
    """What `quality/RUN.json` holds; outliers of binned velocities are not looked for."""
    if recording.nu is not None:
        return assess(recording, anomalies)
    return assess(recording, anomalies, int(find_outliers(recording, settings).sum()))
