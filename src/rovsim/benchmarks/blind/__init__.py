"""The project's own benchmark: hide physics in the tank, ask what is missing, keep the score.

case         one case: what is hidden, and what an answer may say about it
recipes      how strong each effect is when it is hidden
field        cases with a vehicle file that is wrong everywhere, and cameras as they are
recordings   recordings as other laboratories have them, of the vehicles in vehicles/
outside      physics that no entry of the catalogue describes
laws         smooth laws that the catalogue lacks, for the equations
suites       which cases there are
flight       a case becomes a campaign of raw exports
independent  a second simulator that shares no physics with the first
methods      who is asked
asking       the project's own diagnosis
sparse       the baseline: sparse regression
library      the columns of that
tuning       its thresholds
run          cases are run, each once
answers      what was answered, as it is kept
score        one answer against the truth
law_score    equations against the laws that were hidden
calibration  is what answers claim of themselves true?
summary      many scores put together
tables       the tables of the page
pictures     its pictures
"""
