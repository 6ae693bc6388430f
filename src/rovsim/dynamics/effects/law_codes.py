"""Numbers of a law's factors and of what its terms act on, as the parameters of `Law` hold them."""

# Factors. Three kinds of each velocity and two of the world's down in body axes: + the axis.
VELOCITY, SIZE, SIGN = 0, 6, 12
DOWN, SIGN_OF_DOWN = 18, 21
SPEED, DIRECTION, NORTH, EAST, DEEP, NEAR = range(24, 30)
NONE = -1
# What a term acts on, beside an axis of the body (0 to 5): an axis of the world (+ 0 to 2), the
# water's velocity north and east (+ 0, 1), and water that turns.
WORLD, WATER, SWIRL = 6, 9, 11
