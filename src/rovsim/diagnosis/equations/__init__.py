"""An equation for what no effect of the catalogue explains, or the force in time where none is.

form         what a law is, whatever it is made of
products     laws that are sums of products of what acts at the same instant
with_memory  laws that remember: a wake by axis, play of the thrusters
with_thrust  laws of the thrust: along one axis it pushes along another, or with the motion
action       where a law acts, and whether something is left there
effect_file  a law as a file that can be read and edited
fitted_law   a law on top of what was selected
law_fits     laws fitted beside hypotheses, and what they are worth
law_search   the likeliest law: products, laws with a memory, laws of the thrust
masked       a law that names of the catalogue stand in for
proposal     whether it holds, and what it is worth
disturbance  the force in time, where none does
spectrum     how fast that force is
describe     either of them as `diagnosis.json` says it
"""
