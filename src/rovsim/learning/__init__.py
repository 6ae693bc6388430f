"""Trains residuals: models of the acceleration that physics leaves unexplained.

pairs               training pairs: features, and the acceleration that the model lacks
scaling             scales features, so that none dominates the distance between samples
settings            settings that every learner has
learner             what every learner declares, how learners are found, and training
learners            one file for each learner: nearest neighbours, Gaussian processes
gaussian            what exact and sparse Gaussian processes share
determinism         makes PyTorch give the same numbers for the same seed
cross_validation    judges a learner on stretches that were left out
tree                a packed tree of bounding boxes for the nearest neighbours
posterior_variance  a variance of Gaussian processes that is cheap enough for a control loop
export              turns a trained residual into the array that kernels evaluate
"""
