"""Effects that a user wrote: read from a file, checked, and tried before anything is simulated.

effects_file   effects of a file, by id
declarations   their declarations: types and ranges
trials         their methods, called with examples on a vehicle
kernel_trials  their kernels, at many instants
"""
