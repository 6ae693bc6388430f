"""How sure the values of an answer are: what further is not known makes them less so.

identifiability      which values are known only together?
nuisance_parameters  what would not be known if further parameters were free
common_scale         does a factor of all forces stay open?
rest_of_file         what does the rest of a loose vehicle file leave open?
file_values          final values, where all of such a file is fitted with what was selected
"""
