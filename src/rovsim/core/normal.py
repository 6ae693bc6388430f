"""Numbers of the normal distribution."""

INTERVAL = 1.96  # standard deviations; as many to either side hold 95 %
MAD = 1.4826  # a standard deviation, in median absolute deviations
