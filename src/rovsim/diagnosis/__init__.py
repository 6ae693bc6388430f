"""Which physical effects a model lacks, how sure that is, and what is left unexplained.

selection        which effects explain that: candidates, search, fits, what else they could be
structure        is there structure in what is left?
uncertainty      how sure values are
checks           what is asked of the runs and of values
equations        a law for what is left, where one holds
answer           what was selected, validated, at its final values, and what that leaves
explanation      what explains the runs: observed, searched, settled
procedure        the same, finished and named: a whole diagnosis
train_diagnosis  what comes of it
advice           what to record next
result           what is written of it
of_campaign      a campaign in, all that is reported out; test runs are opened here, once
settings         how thorough
apply            a model with the effects that were found
"""
