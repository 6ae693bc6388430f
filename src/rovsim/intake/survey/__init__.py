"""What is in files that nobody has described yet.

gather         lists the files and bags that were named, or lie in named folders
sniff          recognises the format of a file
contents       what a file holds: motions, and what looks like commands
look           looks into a file by the reader of its format
bags           finds motions in ROS 2 bags
csv_files      looks into csv files
csv_commands   finds commands among the columns of a csv file
other_numbers  columns of a csv file that are numbers and no measured channel
headings       copies a csv file whose columns have other names or units, with ours
command_names  what names of columns say of commands: forces and moments, sticks, units
column_names   other names of our channels
sizes          finds units by the size of the numbers
time_units     finds the unit of times
starts         finds when recordings began, by the headers of their files
repeats        refuses several runs or bodies in one file; tells stamps that are too coarse
quaternions    refuses numbered columns that may be a quaternion
timing         rates, jitter and gaps of times
"""

from rovsim.intake.survey.contents import Contents, Track
from rovsim.intake.survey.gather import gather
from rovsim.intake.survey.look import look

__all__ = ["Contents", "Track", "gather", "look"]
