"""The way of the data, one step a file: commands, workbench and workflow call the same functions.

reading           raw exports -> recordings; what speaks for and against them
recordings        a campaign -> motions, poses before the filter, quality
models            names and files -> models; a model file with effects added
replays           models x motions -> replays -> scores, growth of errors, steps of the ladder
bands             how surely models predict, and what of the test runs lies inside
error_conditions  under which conditions a model fails
diagnosis         which effects a model lacks
given_diagnosis   one that a user gives, of the open campaign
shown_diagnosis   the same with figures, tracked, by another process
design            the flight that would tell most
result_cache      diagnoses that are found again where nothing changed
refit             the nominal model's own parameters, fitted
training          a learned residual on top of a model; how long its predictions take
comparison        replays, scores, conditions and forces of some models, together
drawing           figures of a study
presentation      tables and report of a study
summary           the study's scores, ladder and growth in one place
held_out          a held-out run: scored, beside published errors, with pitfalls
"""
