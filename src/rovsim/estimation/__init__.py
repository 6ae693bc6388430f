"""Values of given effects by the prediction-error method, and how likely each hypothesis is.

settings             how much of the runs takes part
observer             the model runs along the train runs, corrected: what it could not foresee
prior                what is known of parameters before the runs are looked at
levenberg_marquardt  damped least squares
fit                  the most likely parameters of a hypothesis, and their spread
replay_fit           values that replay best, where structure is left
candidates           every effect of the catalogue, from each of its starts
sensitivities        how each would change the innovations, to first order
remaining_noise      of what a hypothesis leaves and none of them explains
white_columns        the same under one noise, beside what was found
file_effects         what a vehicle file states, as terms, and how far such files are off
refit                the file fitted alone: a step of the ladder to compare with
"""
