"""Codes of the factors of a law's terms, and of what the terms act on: parameters of `Law`."""

# Factors. Of nu_r (+ axis 0 to 5): the velocity, its absolute value, its sign. Of the NED z axis in
# body axes (+ axis 0 to 2): the component, its sign.
VELOCITY, SIZE, SIGN = 0, 6, 12
DOWN, SIGN_OF_DOWN = 18, 21
SPEED, DIRECTION, NORTH, EAST, DEPTH, NEARNESS = range(24, 30)
NO_FACTOR = -1
# What a term acts on, beside an axis of the body (0 to 5): a NED axis (+ 0 to 2), the velocity of
# the water north and east (+ 0, 1), and the angular rate of water that turns about a place.
WORLD, WATER, SWIRL = 6, 9, 11
