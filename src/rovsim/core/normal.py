"""Numbers of the normal distribution."""

Z_95 = 1.96  # standard deviations; as many to either side hold 95 %
STD_PER_MAD = 1.4826  # standard deviation over the median absolute deviation
