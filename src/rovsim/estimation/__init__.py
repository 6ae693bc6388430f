"""Fits the values of given effects by the prediction-error method, and compares hypotheses.

settings             how much of the runs takes part
prior                what is known of parameters before the runs are used
kernels              compiled: filters of one axis, and Whittle's likelihood
observer             runs a model along the measurement, corrected by filters: gives innovations
levenberg_marquardt  damped least squares
fit                  the likeliest parameters of a hypothesis, their covariance, and the noise
replay_fit           values that replay best, for a model that is known to be incomplete
candidates           effects that may be missing: all of the catalogue, from each of their starts
sensitivities        how each candidate would change the innovations, to first order
remaining_noise      the noise that is left beside a hypothesis and all candidates
white_columns        the sensitivities, whitened, with the accepted effects in place
file_effects         values that the vehicle file states, and how far such files are off
refit                refits the vehicle file alone: a step of the ladder to compare with
"""
