"""How far a model is from the measurement.

error_metrics     errors and metrics: one definition of each number
ladder            the error of one model after the other, on the test runs
growth            how the error grows with the time since the start of a window
score_collector   all errors of several models, run by run
force_budget      how much each part of a model pushes along a run, and what is missing
coverage          whether bands contain as much of the measurement as they should
latency           how long one prediction takes
error_conditions  where a model fails: its error by axis and condition
commanded_motion  does the vehicle do what was commanded?
held_out          each run held out once, beside the errors that others published
"""
