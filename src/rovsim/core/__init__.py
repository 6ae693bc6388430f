"""What all packages use, and what uses none of them: errors, files, rotations, progress, runs.

errors          errors that say what was found, where, what was expected, and what to do
files           files that appear whole or not at all
yaml_files      YAML, read safely and written
array_files     arrays in `.npz` files, without pickle
schema          typed sections of YAML
mappings        nested mappings by dotted names
names           checks names that people give
model_names     names of the built-in models
signs           minus signs of numbers in text
rounding        numbers rounded to significant digits
columns         text that fits a terminal
progress        how far long work is, and the time left
axes            the six axes, their letters and units
horizons        lengths of the windows of replays
run             id, split and commands of a run, and the site it was recorded at
pwm             pulses of a radio control, and what they command
rotations       rotations and axis conventions
odds            odds, as likelihood-ratio statistics and back
normal          numbers of the normal distribution
robust          statistics that a few wrong values do not change
gauss_markov    noise with a correlation time, of unit variance
bounded_cache   a cache with a limit: what it dropped is computed again
threads         work on all cores, in threads
collector       when Python collects garbage, and returns memory to the system
second_process  a second process for work that needs other libraries
termination     treats SIGTERM like Ctrl-C
extras          packages that only some commands need
shipped         files that come with rovsim
making          when, from which commit and on which machine a result was made
"""
