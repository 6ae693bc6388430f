"""Benchmarks: how fast rovsim is, and whether it finds physics that is hidden in a tank.

blind    hides physics in a tank, asks methods what is missing, and scores their answers
designs  do designed flights tell what they promise?
speed    how fast replay and inference are, beside other libraries
"""
