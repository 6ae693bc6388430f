"""What is asked of an answer.

residual_structure   does what is left vary with something? (residual, regressors,
                     spectral_lines, sudden_pushes)
identifiability      which values are known only together?
noise_floor          what would a perfect model score?
"""
