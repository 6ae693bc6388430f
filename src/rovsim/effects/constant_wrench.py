"""A trim that never changes."""

from rovsim.effects.base import Wrench, per_axis


class ConstantWrench(Wrench):
    """A constant wrench in body axes: a trim error, a thruster that idles."""

    id = "constant_wrench"
    equation = r"\tau_i = c_i"
    neglects = "everything it might depend on"
    source = "definition"
    parameters = per_axis("N", "N m", "c", scales=(2.0, 0.2))

    @staticmethod
    def wrench(at, p):
        """The six constants."""
        return p.surge, p.sway, p.heave, p.roll, p.pitch, p.yaw
