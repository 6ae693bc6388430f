"""A model written for another simulator, and what that simulator cannot hold.

equation  the constants of the equation of motion as text
holding   what of a model a target can hold, what is left out, and why
sizes     how large the forces are that a target leaves out
targets   one simulator a file: what it can hold, and how a model is written for it
xml       what targets that write XML have in common
write     writes a model to a file, all steps together
"""
