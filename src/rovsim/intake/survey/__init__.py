"""What is in files that nobody has described yet.

gather         the files and bags that were named, also by their folder
sniff          which format a file has, by what its readers declare
contents       what it holds: motions, and what looks like commands
look           that, by the readers of `recording`
bags           in ROS 2 bags
logs           in ArduPilot logs
csv_files      in csv files
other_numbers  their columns of numbers that are no measured channel
headings       csv files whose columns have other names or units: a copy with ours
command_names  what names say of commands: forces and moments, sticks, other units
column_names   our channels in other words
sizes          units that the size of the numbers tells
time_units     that of times
starts         when recordings began, by the headers of their files
repeats        several runs or bodies in one file, stamps that are too coarse
quaternions    numbered columns that may be one
timing         rates, jitter, gaps
"""

from rovsim.intake.survey.contents import CommandCandidate, Contents, Track
from rovsim.intake.survey.gather import gather
from rovsim.intake.survey.look import look

__all__ = ["CommandCandidate", "Contents", "Track", "gather", "look"]
