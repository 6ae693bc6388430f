"""Synthetic campaigns, written as raw exports with the truth sealed beside them.

settings     what a campaign is made of
campaign     a whole campaign
true_run     one run: pilot, thrusters, vehicle and turbulence, in closed loop
pilot        who moves the sticks
sent_log     a flight that a log prescribes
allocation   what a demand asks of thrusters and surfaces
turbulence   what pushes and nobody logs
sensors      what sensors without cameras report
exports      files as the laboratory's software writes them
description  `campaign.yaml`, and the sealed answer
"""
