"""A second simulator that shares no physics with the tank, the replay and the diagnosis.

Everything here is stated again from the vehicle file and the catalogue's equations: momentum in the
world instead of velocity in the body, no Coriolis matrix, rotation vectors instead of quaternions,
SciPy's DOP853 under error control instead of fixed steps, thrusters as part of the differential
equation, a pilot and exports of its own. Only the settings of a case are shared, as plain data:
`lint-imports` refuses what knows any physics.

vehicle    constants from the vehicle file, and the hidden effects that change them
thrusters  from a logged command to the force of each thruster
pushes     forces on the hull
motion     the motion from the momentum in the world
pilot      sines on the sticks around slow journeys
exports    what cameras and log make of a run
campaign   raw exports and `campaign.yaml`
"""
