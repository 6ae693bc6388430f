"""The way of the data, one step a file: commands, workbench and workflow call the same functions.

recorded_run       raw exports of a run -> its recording, and what was wrong with them
quality            a recording -> a report on its quality, with doubts about it
motion             poses of a run -> its motion
measured_campaign  a whole campaign -> motions, poses before the filter, quality
models             names and files -> models; a model file with effects added
replays            models x motions -> replays -> scores, growth of errors, steps of the ladder
bands              bands of models, and how much of the test runs lies inside
error_conditions   under which conditions a model fails
diagnosis          which effects a model lacks
given_diagnosis    reads a diagnosis that a user gives, and checks that it is of this campaign
shown_diagnosis    a diagnosis with figures, tracked; made by another process
design             the flight that would tell most
result_cache       keeps diagnoses, and finds them again where nothing changed
finished_runs      runs of a sweep that are complete, kept where nothing changed
refit              the nominal model with its own parameters fitted
training           a learned residual on top of a model, and how long its predictions take
comparison         replays, scores, conditions and forces of several models together
drawing            figures of a study
study_tables       tables of a study
study_report       its report
summary            the study's scores, ladder and growth in one place
held_out           a held-out run: its scores, beside published errors and pitfalls
"""
