"""Smooth laws that the catalogue does not have, and for which an equation should be found.

They have the form of effects that are not listed, as in `outside`.
"""

from math import exp, sqrt, tanh

import numpy as np
from numba import njit

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter, Wrench

# Linear (N s/m) and quadratic (N s2/m2) drag of the default vehicle in surge, sway, heave.
DRAG_COEFFICIENTS = ((13.7, 141.0), (0.0, 217.0), (33.0, 190.0))


@njit(forceinline=True)
def added(drag, v, water):
    """Return the force on one axis, N, by which moving water changes the drag.

    Args:
        drag: linear (N s/m) and quadratic (N s2/m2) coefficient.
        v: velocity of the vehicle through still water along the axis, m/s.
        water: velocity of the moving water along the axis, m/s.
    """
    a = v - water
    return drag[0] * water + drag[1] * (abs(v) * v - abs(a) * a)


@njit(forceinline=True)
def carried(at, north, east):
    """Return the force (surge, sway, heave; N) of water that moves north and east, m/s."""
    (a, b, c), (d, e, f) = at.R[0], at.R[1]
    return (
        added(DRAG_COEFFICIENTS[0], at.nu_r[0], a * north + d * east),
        added(DRAG_COEFFICIENTS[1], at.nu_r[1], b * north + e * east),
        added(DRAG_COEFFICIENTS[2], at.nu_r[2], c * north + f * east),
    )


class CoupledCubic(Wrench):
    """A drag in sway that only motion ahead wakes up."""

    id = "coupled_cubic"
    listed = False
    equation = r"Y = -c\,u^2 v"
    neglects = "the moment"
    source = "Abkowitz 1964 (third-order terms)"
    parameters = (Parameter("coefficient", "N s3/m3", "c", scale=250.0),)

    @staticmethod
    def wrench(at, p):
        """Sway force."""
        u, v = at.nu_r[0], at.nu_r[1]
        return 0.0, -p.coefficient * u * u * v, 0.0, 0.0, 0.0, 0.0


class DriftMoment(Wrench):
    """A moment in yaw that grows with the third power of the drift."""

    id = "drift_moment"
    listed = False
    equation = r"N = -c\,v^3"
    neglects = "the force"
    source = "Abkowitz 1964 (third-order terms)"
    parameters = (Parameter("coefficient", "N s3/m2", "c", scale=80.0),)

    @staticmethod
    def wrench(at, p):
        """Yaw moment."""
        v = at.nu_r[1]
        return 0.0, 0.0, 0.0, 0.0, 0.0, -p.coefficient * v * v * v


class TurningDrag(Wrench):
    """Turning takes more the faster the vehicle drifts."""

    id = "turning_drag"
    listed = False
    equation = r"N = -c\,|v|\,r"
    neglects = "the force"
    source = "Norrbin 1971 (second-order modulus terms)"
    parameters = (Parameter("coefficient", "N m s2/(m rad)", "c", scale=8.0),)

    @staticmethod
    def wrench(at, p):
        """Yaw moment."""
        return 0.0, 0.0, 0.0, 0.0, 0.0, -p.coefficient * abs(at.nu_r[1]) * at.nu_r[5]


class TurningSway(Wrench):
    """Turning ahead throws the vehicle outwards."""

    id = "turning_sway"
    listed = False
    equation = r"Y = c\,|u|\,r"
    neglects = "the moment"
    source = "Norrbin 1971 (second-order modulus terms)"
    parameters = (Parameter("coefficient", "N s2/(m rad)", "c", scale=30.0),)

    @staticmethod
    def wrench(at, p):
        """Sway force."""
        return 0.0, p.coefficient * abs(at.nu_r[0]) * at.nu_r[5], 0.0, 0.0, 0.0, 0.0


class DivingMoment(Wrench):
    """A moment in pitch when the vehicle heaves while it goes ahead."""

    id = "diving_moment"
    listed = False
    equation = r"M = c\,u\,w"
    neglects = "the force"
    source = "Fossen 2021, sec. 6.3 (Munk moment), for another hull"
    parameters = (Parameter("coefficient", "N s2/m", "c", scale=40.0),)

    @staticmethod
    def wrench(at, p):
        """Pitch moment."""
        return 0.0, 0.0, 0.0, 0.0, p.coefficient * at.nu_r[0] * at.nu_r[2], 0.0


class Whisker(Wrench):
    """A brush at the bow drags along the floor: a moment of one size against the drift."""

    id = "whisker"
    listed = False
    equation = r"N = -c\,\tanh(v / 0.01)"
    neglects = "the force"
    source = "Coulomb's law, smoothed as in `dry_friction`"
    parameters = (Parameter("moment", "N m", "c", scale=0.4),)

    @staticmethod
    def wrench(at, p):
        """Yaw moment."""
        return 0.0, 0.0, 0.0, 0.0, 0.0, -p.moment * tanh(at.nu_r[1] / 0.01)


class Canopy(Wrench):
    """A net over the frame: a drag along the motion that grows with the whole speed."""

    id = "canopy"
    listed = False
    equation = r"(X, Y, Z) = -c\,U\,(u, v, w)"
    neglects = "the moment"
    source = "Morison 1950 (drag of a body alike from all sides)"
    parameters = (Parameter("coefficient", "N s2/m2", "c", scale=60.0),)

    @staticmethod
    def wrench(at, p):
        """Along the motion of the centre."""
        u, v, w = at.nu_r[0], at.nu_r[1], at.nu_r[2]
        f = -p.coefficient * sqrt(u * u + v * v + w * w)
        return f * u, f * v, f * w, 0.0, 0.0, 0.0


class Swirl(Wrench):
    """The water of the whole tank turns about one place."""

    id = "swirl"
    listed = False
    equation = r"v_c = \omega\,\hat z \times (r - r_0)"
    neglects = "walls, and the force of water that accelerates"
    source = "rotation of a rigid body"
    parameters = (
        Parameter("rate", "1/s", r"\omega", scale=0.06),
        Parameter("x", "m", "x_0", default=5.0, scale=1.0),
        Parameter("y", "m", "y_0", default=2.5, scale=0.5),
    )

    @staticmethod
    def wrench(at, p):
        """Drag of the water that turns."""
        north = at.position[0] - p.x * at.axes[0]
        east = at.position[1] - p.y * at.axes[1]
        X, Y, Z = carried(at, -p.rate * east, p.rate * north)
        return X, Y, Z, 0.0, 0.0, 0.0


class Shear(Wrench):
    """A current along the tank that is faster on one side."""

    id = "shear"
    listed = False
    equation = r"v_c = s\,(e - e_0)\,\hat n"
    neglects = "walls, and the force of water that accelerates"
    source = "a linear profile"
    parameters = (
        Parameter("slope", "1/s", "s", scale=0.03),
        Parameter("y", "m", "y_0", default=2.5, scale=0.5),
    )

    @staticmethod
    def wrench(at, p):
        """Drag of the water that passes."""
        east = at.position[1] - p.y * at.axes[1]
        X, Y, Z = carried(at, p.slope * east, 0.0)
        return X, Y, Z, 0.0, 0.0, 0.0


class Stream(Wrench):
    """Water streams out of a hole in one corner."""

    id = "stream"
    listed = False
    equation = r"v_c = a\,e^{-|r - r_0|^2 / 2 s^2}\,\hat e"
    neglects = "how the stream widens"
    source = "Gaussian profile of a round jet"
    parameters = (
        Parameter("speed", "m/s", "a", scale=0.25),
        Parameter("x", "m", "x_0", default=4.0, scale=0.8),
        Parameter("y", "m", "y_0", default=2.0, scale=0.4),
        Parameter("width", "m", "s", low=0.05, default=0.9, scale=0.2),
    )

    @staticmethod
    def wrench(at, p):
        """Drag of the stream."""
        north = at.position[0] - p.x * at.axes[0]
        east = at.position[1] - p.y * at.axes[1]
        speed = p.speed * exp(-(north * north + east * east) / (2.0 * p.width * p.width))
        X, Y, Z = carried(at, 0.0, speed)
        return X, Y, Z, 0.0, 0.0, 0.0


class SideWake(Coefficients):
    """A wake that forms behind the side alone, and goes on pushing there."""

    id = "side_wake"
    listed = False
    equation = r"Y = -c\,(v - m),\quad T \dot m = v - m"
    neglects = "more than one time constant"
    source = "Fossen 2021, sec. 6.2 (fluid memory), of one axis"
    parameters = (
        Parameter("coefficient", "N s/m", "c", low=0.0, scale=30.0),
        Parameter("time_constant", "s", "T", low=0.1, default=1.5, scale=0.5),
    )

    def enter(self, body: Body) -> None:
        """Add fluid memory in sway; all else is as in `fluid_memory`."""
        if self["coefficient"]:
            memory = np.array([0.0, self["coefficient"], 0.0, 0.0, 0.0, 0.0])
            body.remember(memory, self["time_constant"])
