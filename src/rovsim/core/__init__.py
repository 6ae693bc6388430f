"""What every room needs and what needs nothing: errors, files, rotations, progress, runs.

errors          what was found, where, what was expected, what to do
files           files that appear whole or not at all
yaml_files      YAML, read safely and written
array_files     arrays in `.npz` files, without pickle
schema          typed sections of YAML
mappings        nested mappings by dotted name
names           names that people give
model_names     what models are called
signs           numbers below zero in text
columns         text that fits a terminal
progress        how far long work is, and the time that is left
axes            letters and units of the six axes
horizons        how far replays look ahead
run             which run a thing belongs to, what was commanded, where
pwm             pulses of a radio control, and what they command
rotations       rotations and axis conventions
odds            odds, as likelihood-ratio statistics and back
normal          numbers of the normal distribution
robust          statistics that a few wrong values do not move
gauss_markov    noise that lasts: drawn from step to step, of unit variance
bounded_cache   values that are made again where memory did not hold them
collector       when Python collects, and what is given back to the system
second_process  a second process for what needs other libraries
termination     SIGTERM as Ctrl-C
extras          packages that only some commands need
shipped         files that come with rovsim
making          when, from which commit and on which machine something is made
"""
