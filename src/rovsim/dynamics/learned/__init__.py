"""Evaluates a trained residual in a simulation: its features, kernels and file. Trains nothing.

settings          settings of a residual: the runs it learned from, and its features
features          assembles features of samples: velocity, thrust, acceleration, gravity
layout            order of the numbers in the array that holds an exported residual
predictor         evaluates a residual at one sample or at many
neighbours        mean of the k nearest training points
tree_search       finds these in a tree of bounding boxes
kernel_expansion  mean and variance of a Gaussian process
simd              arithmetic on several points side by side
residual          writes and reads trained residuals
checks            refuses arrays that the kernels could not read safely
"""
