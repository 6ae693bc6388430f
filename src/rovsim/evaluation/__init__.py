"""How far model and measurement are apart.

scores            errors and metrics: one definition of each number
scored            all that is said of some models, run by run
ladder            the error falling, model by model
growth            how the error grows with the time since the start of a window
force_budget      who pushes how much along a run, part by part, and what is missing
coverage          do bands hold what they promise?
latency           how long one prediction takes
error_conditions  where a model fails: its error by axis and condition
commanded_motion  does a vehicle do what was commanded?
held_out          each run held out once, beside others' published errors
"""
