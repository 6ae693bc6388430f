"""What is asked of the runs and of an answer's values.

standstills    does the vehicle stand still although the model would move?
commanded      what could have been commanded, and never was?
observability  which effects could these runs not show?
wrong_units    which values are so far off that a unit may be wrong?
noise_floor    what would a perfect model score?
"""
