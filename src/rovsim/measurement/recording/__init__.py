"""Raw exports in, recordings out: one module per format, axes converted once.

readers        the formats; a new one is a module here that declares its reader
exports        what a reader returns
attitudes      finds quaternions and matrices that are no rotations
signature      recognises a format by the start of a file
qtm_tsv        Qualisys Track Manager
motive_csv     OptiTrack Motive
c3d            C3D with rigid bodies
csv            measured channels in columns that name their units
csv_checks     refuses numbers that a measured channel cannot have
commands_csv   commands in columns
rosbag2        ROS 2 bags
ardupilot      ArduPilot logs
delimited      text in columns: names, separators, lines
cells          cells of text: a number, or "not measured"
numbers        whole columns of numbers
named_columns  columns by their names, and errors where one is missing
units          units of columns, behind their names or in a line below
times          reads a column of times
dates          reads times that are dates
foreign        turns errors of other libraries into one message
channels       each kind of measurement at its own times
commands       turns logged values into commands
joined         puts several files of one run together
one_run        refuses a file whose times begin again: it holds two recordings
repairs        how many lines were repaired or left out
tidying        sorts by time, and keeps each time once
reading        reads the files of a run into a recording
repeated       removes poses that only repeat the line before
recording      a run as it was logged, before any filter
"""

from rovsim.core.run import Commands, RunInfo, Site
from rovsim.measurement.recording.reading import read_run, site
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.recording.repairs import Anomalies

__all__ = [
    "Anomalies",
    "Commands",
    "Recording",
    "RunInfo",
    "Site",
    "read_run",
    "site",
]
