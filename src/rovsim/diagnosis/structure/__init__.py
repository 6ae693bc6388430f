"""Is what an answer leaves noise, or does it have structure?

response            how pushes show in what a fit leaves
uncertain_commands  when a command log does not say which command acted: lost lines, jitter
unknown_thrust      where the command log does not say whether a thruster turned
residual            what is left on one axis, and how a push there would show in it
regressors          does it depend on state, place or time?
spectral_lines      is it periodic?
sudden_pushes       is it sudden?
residual_structure  all of these tests together
"""
