"""How sure the values of an answer are, given what else may be wrong.

identifiability      which values are only known together, and which may as well be absent
nuisance_parameters  how much less sure a fit would be with further parameters free
camera_delay         which delay is the filter of the cameras, and which that of thrust
common_scale         a factor of all forces and inertias that the runs do not determine
rest_of_file         widens intervals by what is unknown of the rest of a loose vehicle file
file_values          final values where all values of a loose vehicle file are fitted
"""
