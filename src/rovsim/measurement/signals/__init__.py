"""From a recording to a motion: poses, velocities and accelerations on a clean clock.

clock            uniform clocks, and the usable stretches on them
outliers         finds frames that cannot be true
half_turns       finds frames in which a body was found half a turn off
neighbours       finds single frames that do not fit the frames beside them
resample         puts poses on a uniform clock; long gaps stay gaps
chosen_channels  chooses the channels that tell best how a vehicle turned and moved
on_clock         puts channels on a uniform clock
track            estimates a pose from whatever channels were measured
measured         which parts of a motion were measured
filter           zero-phase low-pass filters
differentiate    body velocities and accelerations
binned           recordings that come as means over bins
motion           poses, and a motion with velocities and accelerations
chain            all of these steps in order
"""
