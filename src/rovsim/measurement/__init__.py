"""What was recorded. Knows no dynamics.

campaign_file  the keys of `campaign.yaml`
unanswered     lines that `rovsim init` left to its reader
campaign       a campaign: one folder of recordings
loading        from that file to a checked campaign
sensors        where sensors sit, and how late they are
recording      raw exports in, recordings in NED and FRD out
signals        from poses to velocities and accelerations
rough_motion   recordings on an even clock, to compare them with others
means          are velocities means from line to line? the poses may tell
velocities     are they of the same motion, in our units and axes? the poses tell
quality        how good a recording is
remarks        the same in sentences
held_out       test runs that repeat train runs
runs           the usable runs of a campaign
"""
