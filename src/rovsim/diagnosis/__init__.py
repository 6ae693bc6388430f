"""Which physical effects a model lacks, how sure that is, and what is left unexplained.

The order is that of reading: what comes first does not need what follows.

settings            how a diagnosis decides
selection           which effects of the catalogue are accepted, and their rivals
structure           tests whether what is left is noise
uncertainty         widens intervals by what else may be wrong, as the rest of the vehicle file may
fitted_values       fitted values of an effect, as the document lists them
checks              what the runs could not show, and values that make no sense
equations           a law for what is left, where one holds; else the force in time
answer              the accepted effects, validated, at their final values, and what they leave
validated_search    observes, searches and validates, again where an assumption was wrong
selected_effects    which accepted effects are selected, and which in doubt
train_diagnosis     diagnoses the train runs: all that was found on them
differing_runs      what to do where runs differ
advice              what to record next
unexplained         what no effect explains, as the document has it
diagnosis_document  the same as `diagnosis.json`
campaign_diagnosis  diagnoses a campaign; opens the test runs, once, for the reported errors
apply               makes a model file with the effects that a diagnosis found
"""
