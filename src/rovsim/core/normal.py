"""Numbers of the normal distribution."""

Z_95 = 1.96  # standard deviations; as many to either side hold 95 %
