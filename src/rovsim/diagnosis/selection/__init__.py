"""Which effects explain what a model could not foresee.

candidates           every effect of the catalogue, from each of its starts
sensitivities        how each would change the innovations, to first order
remaining_noise      of what a hypothesis leaves and none of them explains
proposals            what each should explain, and what chance would seem to
promising            which of them are worth a fit
white_columns        the same under one noise, beside what was found
workspace            the runs, the columns, one noise for all; what is fitted already
prior                what is known of parameters before the runs are looked at
levenberg_marquardt  damped least squares
fit                  the most likely parameters of a hypothesis, and their spread
thresholds           where they may lie, which derivatives do not tell
pruning              without what is not worth its penalty
forward_selection    add, refit, swap, prune
vehicle_file         a loose one explains as well what is rarer
steady_current       or one that wanders?
search_result        where that ended, and what else the effects could be
filter_delay         beside what the camera does
paired_comparison    errors of two models, window by window
holdout_validation   stretches that took no part must be replayed no worse
cross_validation     what does not help where it was not fitted goes
cluster_robust       nor what few stretches of time make sure, where a velocity is not measured
joint_fit            much is missing at once: all that could be wrong, then pruned
replay_fit           values that replay best, where structure is left
ranking              each effect's worth, in order
"""
