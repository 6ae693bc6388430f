"""Raw exports in, recordings out: one module per format, axes converted once.

readers        the formats; a new one is a module here that declares its reader
exports        what a reader returns
attitudes      which quaternions and matrices are rotations
signature      what stands at the start of the files of a format
qtm_tsv        Qualisys Track Manager
motive_csv     OptiTrack Motive
c3d            C3D with rigid bodies
csv            measured channels in columns that name their units
csv_checks     what its numbers cannot be
commands_csv   commands in columns
rosbag2        ROS 2 bags
ardupilot      ArduPilot logs
delimited      text in columns: names, separators, lines
cells          what they hold: numbers, or "not measured"
numbers        of whole columns
named_columns  by their names; what is said where one is missing
units          of columns, behind their names or in a line below
times          a column of times
dates          times that are dates
foreign        errors of foreign libraries as one message
channels       each kind of measurement at its own times
commands       logged values become commands
joined         several files of one run
one_run        times that begin anew: two recordings
tidying        sorted by time, each time once
reading        from the files of a run to a recording
repeated       poses that are those of the line before
recording      a run as it was logged, before any filter
"""

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
