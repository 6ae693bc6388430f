"""Raw exports in, recordings out: one module per format, axes converted once.

formats           the formats, one module or package each
readers           what a format declares, and how its module is found
exports           what a reader returns
candidates        what looks like commands before anybody has said so
pulse_candidates  takes pulses of outputs or of a radio for commands
attitudes         finds quaternions and matrices that are no rotations
tables            text in columns
signature         recognises a format by the start of a file
header_times      reads from the header of a file when it began
csv_checks        refuses numbers that a measured channel cannot have
foreign           turns errors of other libraries into one message
channels          each kind of measurement at its own times
commands          turns logged values into commands
joined            puts several files of one run together
one_run           refuses a file whose times begin again: it holds two recordings
repairs           how many lines were repaired or left out
tidying           sorts by time, and keeps each time once
run_files         reads the files of a run into a recording
repeated          removes poses that only repeat the line before
recording         a run as it was logged, before any filter
"""

from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.recording.repairs import Anomalies
from rovsim.measurement.recording.run_files import read_run, site

__all__ = [
    "Anomalies",
    "Commands",
    "Recording",
    "RunInfo",
    "Site",
    "read_run",
    "site",
]
