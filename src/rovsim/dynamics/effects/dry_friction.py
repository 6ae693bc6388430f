"""Friction of solids: the same force against every motion, however slow."""

from math import tanh

from rovsim.dynamics.compilation.compiled import inlined
from rovsim.dynamics.effects.base import Signature, Wrench, per_axis

SMOOTHING_SPEED = 0.01  # m/s or rad/s: a convention of model files, as its equation says


@inlined
def rub(c, v):
    """Friction of size c against a velocity v; 0 at once for c = 0, which costs no tanh."""
    return -c * tanh(v / SMOOTHING_SPEED) if c != 0.0 else 0.0


class DryFriction(Wrench):
    """Something rubs along: the same force against every motion, however slow."""

    id = "dry_friction"
    equation = r"\tau_i = -c_i \tanh(\nu_{r,i} / 0.01)"
    neglects = (
        "sticking, a force that changes with the load, and that in a current the rail stands still"
    )
    source = "Coulomb's law, smoothed as by Andersson et al. 2007, Tribology International 40"
    cause = (
        "The tether slides over the edge of the tank or along its floor, or the vehicle along a "
        "rail or a wall."
    )
    revealed_by = (
        "Let it coast from several speeds on one axis: with dry friction it loses the same speed "
        "in every second and then stops, with drag of water it slows ever more slowly."
    )
    signature = Signature({"surge": 4.0}, "surge", "surge speed")
    parameters = per_axis("N", "N m", "c", scales=(1.0, 0.1), low=0.0)

    @staticmethod
    def wrench(at, p):
        """Friction against the motion along each axis."""
        u, v, w, a, b, c = at.nu_r
        return (
            rub(p.surge, u),
            rub(p.sway, v),
            rub(p.heave, w),
            rub(p.roll, a),
            rub(p.pitch, b),
            rub(p.yaw, c),
        )
