"""Is there structure in what an answer leaves, or is it noise?

residual            what is left on one axis, and how a push there would show in it
unknown_thrust      where the log does not say what the thrusters did
regressors          does it vary with state, place or time?
spectral_lines      does it come back?
sudden_pushes       does it come at once?
residual_structure  all of these together
"""
