"""A second simulator that shares no physics with the tank, the replay and the diagnosis.

Everything here is stated again from the vehicle file and the catalogue's equations: momentum in the
world instead of velocity in the body, no Coriolis matrix, rotation vectors instead of quaternions,
SciPy's DOP853 under error control instead of fixed steps, thrusters as part of the differential
equation, a pilot and exports of its own. Only the settings of a case are shared, as plain data:
`lint-imports` refuses what knows any physics.
"""
