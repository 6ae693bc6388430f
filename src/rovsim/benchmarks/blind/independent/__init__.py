"""A second simulator that shares no physics with the tank, the replay and the diagnosis.

Everything here is stated again from the vehicle file and the catalogue's equations. It integrates
momentum in the world instead of velocity in the body, without a Coriolis matrix, with rotation
matrices instead of quaternions, and with SciPy's DOP853 under error control instead of fixed steps.
Thrusters are part of the differential equation; pilot and exports are its own. Only the settings of
a case are shared, as plain data: `lint-imports` refuses imports of modules that know any physics.

vehicle    constants from the vehicle file, and the hidden effects that change them
thrusters  from a logged command to the force of each thruster
pushes     forces on the hull
motion     the motion from the momentum in the world
pilot      sines on the sticks around slow journeys
exports    what cameras and log make of a run
campaign   raw exports and `campaign.yaml`
"""
