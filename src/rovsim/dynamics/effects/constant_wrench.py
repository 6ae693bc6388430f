"""A trim that never changes."""

from rovsim.dynamics.effects.base import Signature, Wrench, per_axis


class ConstantWrench(Wrench):
    """A constant wrench in body axes: a trim error, a thruster that idles."""

    id = "constant_wrench"
    differs_between_runs = True
    equation = r"\tau_i = c_i"
    neglects = "everything it might depend on"
    source = "definition"
    cause = "A thruster idles, the sticks are off their centre, or a trim was set by hand."
    revealed_by = (
        "Drift without commands at four headings and leaning to both sides: a constant wrench "
        "turns with the body, net buoyancy, a current and a tether stay with the world."
    )
    signature = Signature({"surge": 4.0}, "surge", "heading")
    parameters = per_axis("N", "N m", "c", scales=(2.0, 0.2))

    @staticmethod
    def wrench(at, p):
        """The six constants."""
        return p.surge, p.sway, p.heave, p.roll, p.pitch, p.yaw
