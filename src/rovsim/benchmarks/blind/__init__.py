"""The blind benchmark: hide physics in a tank, ask methods what is missing, score their answers.

case         one case: what is hidden, and which answers to it are right
recipes      how large each effect of the catalogue is when it is hidden
field        cases with a vehicle file that is wrong everywhere, and with imperfect cameras
recordings   cases with recordings as other laboratories have them, of the vehicles in vehicles/
outside      physics that the catalogue does not have
laws         smooth laws that the catalogue does not have, for the search for equations
laws_of_thrusters   such laws of how thrusters answer
known_laws   the laws that are hidden, and what an equation for each has to be made of
suites       which cases there are
flight       makes a campaign of raw exports from a case
independent  a second simulator that shares no physics with the first
methods      the methods that are compared
asking       rovsim's own diagnosis as a method
sparse       the baseline: sparse regression
library      the library of columns of the sparse regression
tuning       chooses the thresholds of the sparse regression
run          runs each case once
answers      an answer as it is stored in a file
score        scores one answer against the truth
law_score    scores proposed equations against the laws that were hidden
calibration  are the probabilities and intervals of the answers right?
summary      puts the scores of many cases together
tables       tables of docs/benchmark_blind.md
pictures     pictures of docs/benchmark_blind.md
"""
