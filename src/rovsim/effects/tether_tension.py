"""A tether that pulls when it is taut."""

from math import sqrt

from rovsim.effects.base import Parameter, Wrench

ANCHOR = tuple(Parameter(f"anchor_{axis}", "m", f"{axis}_a") for axis in "xyz")


class TetherTension(Wrench):
    """A weightless elastic tether from a point on the vehicle to an anchor in the tank."""

    id = "tether_tension"
    equation = r"F = k \max(0, L - L_0) \text{ towards the anchor}"
    neglects = "weight, drag and dynamics of the tether"
    source = "Hooke's law"
    parameters = (
        Parameter("stiffness", "N/m", "k", low=0.0),
        Parameter("slack_length", "m", "L_0", low=0.0),
        *ANCHOR,  # MoCap world axes
        Parameter("attachment_x", "m", "x_t", default=-0.2),  # contract, section 2
        Parameter("attachment_y", "m", "y_t"),
        Parameter("attachment_z", "m", "z_t"),
    )

    @staticmethod
    def wrench(at, p):
        """Pull at the attachment, and its moment about CO."""
        R, x = at.R, (p.attachment_x, p.attachment_y, p.attachment_z)
        north = p.anchor_x * at.axes[0] - at.position[0]
        east = p.anchor_y * at.axes[1] - at.position[1]
        down = p.anchor_z * at.axes[2] - at.position[2]
        # from the attachment to the anchor, in body axes
        a = R[0][0] * north + R[1][0] * east + R[2][0] * down - x[0]
        b = R[0][1] * north + R[1][1] * east + R[2][1] * down - x[1]
        c = R[0][2] * north + R[1][2] * east + R[2][2] * down - x[2]
        length = sqrt(a * a + b * b + c * c)
        pull = p.stiffness * max(0.0, length - p.slack_length) / max(length, 1e-9)
        X, Y, Z = pull * a, pull * b, pull * c
        return X, Y, Z, x[1] * Z - x[2] * Y, x[2] * X - x[0] * Z, x[0] * Y - x[1] * X
