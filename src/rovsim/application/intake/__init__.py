"""From files that nobody has described to a `campaign.yaml` that a person can finish.

survey      all files: what they hold, or one message for each that cannot be used
pairing     which commands belong to which motion: by name, by clock, by what they cause
predicted   which velocity commands ought to cause
likeness    how alike a commanded and a measured motion are, along which axes, how late
vehicles    which vehicle file fits the commands
axes        which way the axes of world and body point
checks      what looks wrong: clocks, mirrored axes, thrusters in another order, gaps
proposal    the campaign with what was found, guessed and is left to ask
yaml_file   the proposal as a commented campaign.yaml
"""
