"""Drag laws that the catalogue does not have, but that its linear and quadratic drag imitate.

They stand beside the catalogue in a diagnosis and are never named as effects (imitation.py).
"""

from rovsim.dynamics.effects.base import Wrench
from rovsim.dynamics.effects.parameters import per_axis
from rovsim.dynamics.engine.compiled import inlined


@inlined
def sign(v):
    """Sign of a velocity, smooth within 0.01 m/s or rad/s."""
    return v / (abs(v) + 0.01)


class DryFriction(Wrench):
    """The same force against every motion, however slow."""

    id = "dry_friction"
    listed = False
    equation = r"\tau_i = -f_i \nu_{r,i} / (|\nu_{r,i}| + 0.01)"
    neglects = "sticking"
    source = "Coulomb's law, smoothed over the noise of a measured velocity (docs/signals.md)"
    parameters = per_axis("N", "N m", "f", scales=(1.0, 0.1))

    @staticmethod
    def wrench(at, p):
        """Against the motion of each axis."""
        u, v, w, a, b, c = at.nu_r
        return (
            -p.surge * sign(u), -p.sway * sign(v), -p.heave * sign(w),
            -p.roll * sign(a), -p.pitch * sign(b), -p.yaw * sign(c),
        )  # fmt: skip


class CubicDrag(Wrench):
    """Drag that grows with the third power of speed."""

    id = "cubic_drag"
    listed = False
    equation = r"\tau_i = -d_i \nu_{r,i}^3"
    neglects = "coupling between axes"
    source = "Fossen 2021, sec. 6.4: odd terms of a Taylor expansion"
    parameters = per_axis("N s3/m3", "N m s3", "d", scales=(50.0, 0.5))

    @staticmethod
    def wrench(at, p):
        """Against the motion of each axis."""
        u, v, w, a, b, c = at.nu_r
        return (
            -p.surge * u * u * u, -p.sway * v * v * v, -p.heave * w * w * w,
            -p.roll * a * a * a, -p.pitch * b * b * b, -p.yaw * c * c * c,
        )  # fmt: skip


UNLISTED_DRAG = (DryFriction, CubicDrag)
