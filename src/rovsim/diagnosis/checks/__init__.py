"""What is asked of an answer.

residual             what is left on one axis, and how a push there would show in it
unknown_thrust       where the log does not say what the thrusters did
regressors           does it vary with state, place or time?
spectral_lines       does it come back?
sudden_pushes        does it come at once?
residual_structure   all of these together
common_scale         does a factor of all forces stay open?
nuisance_parameters  what would not be known if further parameters were free
rest_of_file         what does the rest of a vehicle file that is off leave open?
whole_file           all of such a file, fitted together with what was selected
standstills          does the vehicle stand still although the model would move?
commanded            what could have been commanded, and never was?
wrong_units          which values are so far off that a unit may be wrong?
identifiability      which values are known only together?
observability        which effects could these runs not show?
noise_floor          what would a perfect model score?
"""
