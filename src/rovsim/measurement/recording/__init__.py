"""Raw exports in, recordings out: one module per format, axes converted once."""

from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.recording.reading import Anomalies, read_run, site
from rovsim.measurement.recording.recording import Recording

__all__ = [
    "Anomalies",
    "Commands",
    "Recording",
    "RunInfo",
    "Site",
    "read_run",
    "site",
]
