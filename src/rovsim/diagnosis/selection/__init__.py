"""Which effects of the catalogue explain what the model does not predict.

proposals              what each candidate explains to first order, and what chance would explain
first_order            judges additions and removals to first order
fit_cache              fits under one noise, each made once
workspace              the runs, the candidates, one noise for all, and what was fitted already
promising              which candidates are worth a fit
curvature              proposes effects that to first order do what accepted ones do
pruning                removes free parameters that are not worth their penalty
wide_effects           replaces an effect of many parameters by several narrower ones
imitation              removes what undetermined values of another effect make unnecessary
thresholds             finds values of thresholds by trying them, as derivatives do not lead there
search_result          where a search ended: the accepted effects and their rivals
steady_current         chooses between a steady current and one that wanders
vehicle_file           a loose vehicle file competes with effects that are rarer
forward_selection      the search: add, refit, swap, prune
filter_delay           tells a late command from a filter of the cameras, which delays as well
paired_comparison      compares errors of two models window by window
holdout_validation     removes effects with which held-out stretches are replayed worse
cross_validation       removes effects that do not help on blocks they were not fitted to
cluster_robust         removes effects that few blocks support, where a velocity is not measured
joint_fit              where much is missing at once: fits everything that may be wrong, then prunes
accepted_effects       accepted effects as they are reported: how sure values and names are
ranking                orders the accepted effects by the error they remove; ranks each alone
beside_law             what remains of accepted effects beside a law
withdrawn_probability  withdraws the probability of effects that may only be stand-ins
"""
