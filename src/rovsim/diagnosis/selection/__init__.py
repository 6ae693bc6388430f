"""Which effects explain what a model could not foresee.

proposals            what each should explain, and what chance would seem to
promising            which of them are worth a fit
workspace            the runs, the columns, one noise for all; what is fitted already
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
ranking              each effect's worth, in order
"""
