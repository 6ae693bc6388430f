"""How good a recording is, and what to do about it.

usability             whether a recording can be used, and if not, why
excitation            how much it moves along each axis, and whether that suffices
pose_noise            how noisy its poses are
velocity_means        are the recorded velocities means from line to line? compares with poses
velocity_conventions  do the recorded velocities fit the poses, in our units and axes?
copied_runs           finds runs with the same files: copies of train runs, shared logs
unlogged_commands     when a log does not tell what was commanded
remarks               the quality of a recording in sentences
assessment            puts all of this together, as `quality/RUN.json`
"""
