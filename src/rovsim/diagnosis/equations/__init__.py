"""A law for what no effect of the catalogue explains, or the force in time where none holds.

effect_file  writes a law as a Python file that can be read and edited
form         what every form of law can do
fitted_law   a law that was fitted together with the effects beside it
products     laws that are sums of products of states at the same instant
with_memory  laws with a memory: a wake for each axis, how thrusters answer
with_thrust  laws of the thrust: along one axis it pushes along another, or with the motion
action       on which axis a law acts, and whether it leaves structure there
law_fits     fits laws, and judges what they are worth
law_search   searches all forms for the likeliest law
masked       finds a law that accepted effects stand in for
proposal     whether a law holds, and what it is worth
spectrum     how the power of a force is spread over frequencies
disturbance  the force in time, where no law holds
describe     a law or a force in time as `diagnosis.json` has it
"""
