"""A model written for another simulator, and what that simulator cannot hold.

equation  the constants of the equation of motion, as they are written
holding   what of a model a target holds, what is left out, and why
sizes     how large the forces are that are left out
targets   one simulator a file: what it holds, and how it is written
xml       what targets that are written as XML have in common
write     the whole way: a model to a file
"""
