"""A trained residual inside the loop: its features, its kernels, its file. Trains nothing.

settings          the runs it learned from, and what it looks at
features          that, of samples: velocity, thrust, acceleration, gravity
layout            where things stand in an exported residual
predictor         its evaluation, one sample or many
neighbours        the k nearest points
kernel_expansion  mean and variance of a Gaussian process
simd              arithmetic on several points side by side
residual          arrays and the rest, on disk
checks            arrays that kernels can read safely
"""
