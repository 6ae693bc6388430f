"""Raw exports in, recordings out: one module per format, axes converted once, quality told."""

from rovsim.recording.quality import quality_report, usable_reason
from rovsim.recording.reading import Anomalies, read_run, site
from rovsim.recording.recording import Commands, Recording, RunInfo, Site

__all__ = [
    "Anomalies",
    "Commands",
    "Recording",
    "RunInfo",
    "Site",
    "quality_report",
    "read_run",
    "site",
    "usable_reason",
]
