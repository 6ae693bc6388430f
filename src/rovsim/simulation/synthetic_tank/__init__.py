"""Makes synthetic campaigns: raw exports, and beside them a file with the hidden truth.

settings     runs, tank, cameras, sensors and hidden effects of a synthetic campaign
campaign     makes a whole campaign
true_run     one run: pilot, thrusters, vehicle and turbulence, in closed loop
pilot        the pilot who moves the sticks
sent_log     a flight that a command log prescribes
allocation   turns a demand per axis into commands of thrusters and surfaces
turbulence   random forces and currents that are not logged
sensors      what sensors other than cameras report
exports      writes files as the laboratory's software does
description  `campaign.yaml`, and `truth.yaml` with the hidden effects
"""
