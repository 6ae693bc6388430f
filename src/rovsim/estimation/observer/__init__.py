"""A model that runs along a measurement, corrected by a filter: what it could not foresee.

steps             when a run is read, and over which steps models go
observed_run      a run as read, before any filter
train_runs        runs of a campaign, prepared: those parts of long ones that tell most
divergence        where a model runs away although it is corrected
usable_runs       those with something to observe, and whether that is enough
noise             what no model predicts: noise of the readings, a disturbance that lasts
noise_fit         how large it most likely is
whittle           the likeliest sizes of the parts of a noise, compiled
camera_noise      how likely poses are, if the noise of the cameras is of some kind
camera            does the software of the motion capture smooth what it reports?
random_walk       pushes that wander: how they show, and how likely they are
drifting_current  does the water wander?
autoregression    errors of the readings that last
axis_kernels      filters of one axis and their likelihoods, compiled
kalman            the steady filters that suit it, axis by axis
innovations       many models on one run, in one compiled call
filter_bank       all runs, each with its filters: innovations, whitened
hypothesis        a base model and terms, whose parameters may be free
residual_source   errors of a hypothesis, and how they change with its parameters
least_squares     any of many columns, from their Gram matrix
sandwich          how sure values are where the errors of some time go together
windows           errors in windows of 2 s: what users see of a model

How likely something is, is told as `two_log_likelihood`, and how much likelier than something else
as `lr_statistic`, twice the logarithm of the likelihood ratio: odds of 20 to 1 are 6, of a thousand
to one 13.8. Penalties, limits and scores are in the same measure.
"""
