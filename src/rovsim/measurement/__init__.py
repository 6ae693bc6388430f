"""From raw files to clean motions of the runs of a campaign. Knows no dynamics.

campaign_file  the keys of `campaign.yaml`
unanswered     finds questions that `rovsim init` left in a campaign.yaml
campaign       a campaign: one folder of recordings, as its file describes it
loading        reads and checks a campaign.yaml
sensors        where sensors sit on the vehicle, and how late they report
recording      raw exports in, recordings in NED and FRD out
signals        from recordings to velocities and accelerations
rough_motion   recordings on an even clock, to compare them with others roughly
quality        how good a recording is, and what to do about it
runs           the usable runs of a campaign
"""
