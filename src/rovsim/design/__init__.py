"""The next flight: commands that best tell rivals apart, or make a value surer.

settings         what may be asked, and limits that a flight keeps to
surroundings     where, when and with what it would be recorded
steady_push      what pushes for long in the train runs, and the model does not know of
knowledge        what the train runs already tell: fitted hypotheses, and the noise
from_train_runs  how they are fitted to what is asked
sticks           movements of the sticks as a few numbers; the usual manoeuvres
authority        from a wrench that is wanted to what a log of commands would hold
pilot            sticks flown on the model, which keeps the vehicle upright and near: commands
flight           commands to predicted paths, and whether they stay within the limits
record           a predicted path as the observer would see it
worth            what a flight would tell beside the train runs
search           the sticks that tell most
doubts           whether the model can be flown without looking; why no flight is found
plan             all of it, in order
instructions     the same in words
report           the same as `experiment.json`
"""
