"""How functions are compiled for the equation of motion, and where the code is cached.

compiled  decorators: inlined or not, kept or not
cache     one folder for each state of the sources
"""
