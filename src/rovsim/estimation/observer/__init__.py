"""Runs a model along a measurement and corrects it by a filter: what it did not predict is left.

steps             when a run is read, and the integration steps from reading to reading
observed_run      a run as the observer sees it: readings before the filter
lost_lines        commands that a log lost
train_runs        prepares runs of a campaign; of long ones, the parts that tell most
usable_runs       the runs with a usable stretch, and whether they are enough
divergence        runs in which a model diverges although it is corrected
hypothesis        a base model and further effects, whose parameters may be free
kalman            steady-state Kalman filters of one axis
autoregression    how past innovations predict later ones, where axes drive each other
noise             what no model predicts: a disturbance, and noise of the readings
noise_fit         the likeliest noise of innovations
innovations       many models on one run, in one compiled call
residual_source   errors that a hypothesis is fitted to, and their derivatives
least_squares     least squares of any columns, from their Gram matrix
random_walk       forces that are a random walk: how they show, and how likely they are
drifting_current  does the current wander?
filter_bank       the filters of all runs: innovations, whitened, and their derivatives
camera_noise      how likely the noise of poses is, for several kinds of camera noise
camera            does the software of the motion capture smooth the poses?
sandwich          how sure values are where the errors of a stretch of time are related
windows           errors of replays in windows of 2 s: what users see of a model

How likely something is, is given as `two_log_likelihood`, twice the logarithm of the likelihood.
How much likelier it is than something else is its `lr_statistic`, twice the logarithm of the
likelihood ratio: odds of 20 to 1 are 6, of a thousand to one 13.8. Penalties, limits and scores are
in the same measure.
"""
