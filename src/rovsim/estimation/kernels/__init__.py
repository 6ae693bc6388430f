"""Compiled parts of the estimation, kept as those of the simulator are (`dynamics.compilation`).

compiled  how they are compiled
axis      filters of one axis and their likelihoods
whittle   the likeliest sizes of the parts of a noise, from periodograms
"""
