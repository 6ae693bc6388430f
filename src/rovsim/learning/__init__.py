"""Learned residuals: what is left of the acceleration once physics has had its say.

pairs               training pairs: features, and what the acceleration misses
scaling             features brought to one size
settings            what every learner can be told
learner             what every learner declares, and how they are found
learners            one file each: nearest neighbours, Gaussian processes
gaussian            what both Gaussian processes share
determinism         the same numbers for the same seed
cross_validation    judged on stretches that were left out
tree                a packed tree for the neighbours
posterior_variance  a variance that is cheap enough for a control loop
export              laid out for the kernels inside the loop
"""
