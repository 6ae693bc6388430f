"""From raw files to clean motions of the runs of a campaign. Knows no dynamics.

campaign_file  the keys of `campaign.yaml`
unanswered     finds questions that `rovsim init` left in a campaign.yaml
campaign       a campaign: one folder of recordings, as its file describes it
loading        reads and checks a campaign.yaml
sensors        where sensors sit on the vehicle, and how late they report
recording      raw exports in, recordings in NED and FRD out
signals        from recordings to velocities and accelerations
rough_motion   recordings on an even clock, to compare them with others roughly
means          are the recorded velocities means from line to line? compares them with poses
velocities     do the recorded velocities fit the poses, in our units and axes?
quality        how good a recording is
remarks        the quality of a recording in sentences
copied_runs    finds test runs that copy train runs
runs           the usable runs of a campaign
"""
