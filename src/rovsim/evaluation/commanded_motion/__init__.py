"""Does a vehicle do what was commanded? Rough, and without any replay.

predicted          which velocity commands ought to cause
cross_correlation  of a commanded and a measured motion: along which axes, how late
clocks             a motion that does not follow its commands, or too late or too early
conventions        attitudes by other rules than they are read by
doubts             what speaks against a run as its campaign describes it
"""
