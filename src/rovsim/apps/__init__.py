"""Programs around the simulator and the diagnosis.

cli        the command `rovsim`
workbench  the four questions in a browser
notebook   a campaign that is opened, and results that show themselves
gymnasium  the simulator as a Gymnasium environment
fmi        the simulator as a unit of the Functional Mock-up Interface
"""
