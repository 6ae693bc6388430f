"""Does a vehicle do what was commanded? Rough, and without any replay.

predicted          the velocity that commands should cause
cross_correlation  compares commanded and measured motion: along which axes, and how late
clocks             tells a motion that does not follow its commands, or too late or too early
conventions        finds attitudes that were written by another convention than they are read by
doubts             what speaks against a run as its campaign describes it
"""
