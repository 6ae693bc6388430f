"""From poses on a camera clock to velocities and accelerations.

clock            uniform clocks, and the usable stretches on them
outliers         frames that cannot be true
neighbours       single ones that are not where their neighbours have them
resample         poses on a uniform clock; long gaps stay gaps
chosen_channels  which channels tell how a vehicle turned and moved
on_clock         channels on a uniform clock
track            a pose from whatever was measured of it
measured         what that was
filter           zero-phase low-pass filters
differentiate    body velocities and accelerations
binned           recordings that come as means over bins
motion           a run as all of that leaves it
chain            the whole way, step by step
"""
