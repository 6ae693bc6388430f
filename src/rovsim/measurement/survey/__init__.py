"""What is in files that nobody has described yet.

gather      the files and bags that were named, also by their folder
sniff       which format a file has, by what stands in it
look        its motions and what looks like commands, by the readers of `recording`
headings    csv files whose columns have other names or units: a copy with ours
grid        rough velocities on an even clock, to compare recordings with
timing      rates, jitter, gaps
"""

from rovsim.measurement.survey.contents import Contents, Drive, Track
from rovsim.measurement.survey.gather import gather
from rovsim.measurement.survey.look import look

__all__ = ["Contents", "Drive", "Track", "gather", "look"]
