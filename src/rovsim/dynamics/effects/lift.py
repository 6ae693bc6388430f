"""Lift of the hull at an angle of attack."""

from rovsim.dynamics.effects.base import Parameter, Signature, Wrench


class Lift(Wrench):
    """Side and heave force of a hull that moves ahead at an angle of attack; no moment."""

    id = "lift"
    equation = r"Y = -c\,|u_r|\,v_r,\quad Z = -c\,|u_r|\,w_r"
    symbols = (
        ("Y", "force to starboard"),
        ("Z", "force down"),
        ("u_r", "velocity through the water ahead"),
        ("v_r", "velocity through the water to starboard"),
        ("w_r", "velocity through the water down"),
    )
    neglects = "stall, and the moment of the lift"
    source = "Fossen 2021, sec. 6.4 (lift), small angles"
    cause = "The hull meets the water at an angle, like a wing: side panels, floats, fairings."
    revealed_by = (
        "Drift sideways at the same speed with no, half and full surge speed: lift brakes the "
        "drift only while the vehicle also moves ahead, sway damping always."
    )
    signature = Signature({"coefficient": 100.0}, "sway", "absolute surge speed", size=True)
    parameters = (Parameter("coefficient", "kg/m", "c", scale=30.0),)

    @staticmethod
    def wrench(at, p):
        """Lift in sway and heave."""
        c = p.coefficient * abs(at.nu_r[0])
        return 0.0, -c * at.nu_r[1], -c * at.nu_r[2], 0.0, 0.0, 0.0
