"""Constants of the normal distribution."""

Z_95 = 1.96  # standard deviations to either side of the mean that contain 95 %
