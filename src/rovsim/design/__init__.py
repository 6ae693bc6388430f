"""The next flight, by optimal experiment design: it tells rivals apart, or makes values surer.

settings                   what may be asked, and the limits of a flight
recording_setup            where, when and with what a flight would be recorded
low_frequency_disturbance  forces that last, which the model lacks
prior_information          what the train runs tell before the flight
from_train_runs            fits what a question needs to the train runs
inputs                     inputs of a flight as a few numbers, and the usual manoeuvres
authority                  the commands for a wrench that is wanted, and what they do
pilot                      flies inputs on the model, upright and near a place: gives demands
scenarios                  predicts paths for all that is not yet known
envelope                   the limits of a flight, and by how much paths leave them
record                     a predicted path as the observer would see it
expected_information       what a flight would tell beside the train runs: its utility
search                     searches for the flight of the largest utility
safe_flights               flights that stay safe in more scenarios, and what they tell
adequacy                   warns where the model is too poor for a flight, or where none is found
plan                       plans a flight: all of this in order
instructions               a flight in words for a pilot
report                     a plan as `experiment.json`
"""
