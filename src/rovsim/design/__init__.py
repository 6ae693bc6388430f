"""The next flight, by optimal experiment design: what tells rivals apart, or makes a value surer.

settings                   what may be asked, and limits that a flight keeps to
recording_setup            where, when and with what it would be recorded
low_frequency_disturbance  what disturbs for long in the train runs, and no model knows of
prior_information          what the train runs tell: fitted hypotheses, and the noise
from_train_runs            how they are fitted to what is asked
inputs                     movements of the sticks as a few numbers; the usual manoeuvres
authority                  from a wrench that is wanted to what a log of commands would hold
pilot                      inputs flown on the model, kept upright and near: commands
scenarios                  commands to predicted paths, over all that is not yet known
envelope                   the limits, and by how much paths leave them
record                     a predicted path as the observer would see it
expected_information       what a flight would tell beside the train runs: its utility
search                     the flight of the largest utility
adequacy                   whether the model can be flown without looking; why no flight is found
plan                       all of it, in order
instructions               the same in words
report                     the same as `experiment.json`
"""
