"""Trains residuals: models of the acceleration that physics leaves unexplained.

pairs               training pairs: features, and the acceleration that the model lacks
scaling             scales features to one size
settings            settings that every learner has
learner             what every learner declares, and how learners are found
learners            one file each: nearest neighbours, Gaussian processes
gaussian            what both Gaussian processes share
determinism         makes PyTorch give the same numbers for the same seed
cross_validation    judges a learner on stretches that were left out
tree                a packed tree for the nearest neighbours
posterior_variance  a variance that is cheap enough for a control loop
export              lays a trained residual out for the kernels inside the loop
"""
