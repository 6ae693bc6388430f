"""The compiled equation of motion.

types            what the engine passes around
vectors          small vectors as tuples, which live in registers
equation         Fossen's equation of motion
uncommon_forces  of a waterplane, of products of velocities, of control surfaces
kernel_inputs    what effects may read beside the state
as_tuples        one parameter set, one step and one state, out of arrays of all
integration      its integration over steps
observer         a model along a measurement, corrected by it
modules          written modules for lists of effects
"""
