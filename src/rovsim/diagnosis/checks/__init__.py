"""What is asked of an answer.

residual_structure   does what is left vary with something? (residual, regressors,
                     spectral_lines, sudden_pushes), where the log says what thrusters did
                     (unknown_thrust)
common_scale         does a factor of all forces stay open?
rest_of_file         what does the rest of a vehicle file that is off leave open? (left_open)
identifiability      which values are known only together?
observability        which effects could these runs not show?
noise_floor          what would a perfect model score?
"""
