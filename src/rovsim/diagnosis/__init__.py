"""Which physical effects a model lacks, how sure that is, and what is left unexplained.

The order is that of reading: what comes first does not need what follows.

settings         how a diagnosis decides
selection        which effects of the catalogue are accepted, and their rivals
structure        tests whether what is left is noise
uncertainty      widens intervals by what else may be wrong, such as the rest of the vehicle file
checks           what the runs could not show, and values that make no sense
equations        a law for what is left, where one holds; else the force in time
answer           the accepted effects, validated, at their final values, and what they leave
explanation      observes, searches and validates, again where an assumption was wrong
train_diagnosis  all that was found on the train runs
procedure        a whole diagnosis of the train runs: from explanation to train_diagnosis
advice           what to record next
result           the same as `diagnosis.json`
of_campaign      diagnoses a campaign; opens the test runs, once, for the reported errors
apply            makes a model file with the effects that a diagnosis found
"""
