"""Water resistance, axis by axis."""

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Signature, Wrench, per_axis


class LinearDamping(Coefficients):
    """Skin friction: a force against the motion through the water, proportional to it."""

    id = "linear_damping"
    equation = r"\tau_i = -d_i\,\nu_{r,i}"
    neglects = "coupling between axes"
    source = "Fossen 2021, sec. 6.4"
    cause = (
        "The hull drags more or less than the vehicle file says, mostly at low speed: rough foam, "
        "growth, mesh."
    )
    revealed_by = (
        "Hold five steady speeds on one axis from 0.05 m/s upwards, 5 s each, and coast from "
        "each: linear drag grows like the speed, quadratic drag like its square, and a thruster "
        "gain does not show while coasting."
    )
    signature = Signature({"surge": 20.0}, "surge", "surge speed")
    parameters = per_axis("N s/m", "N m s/rad", "d", scales=(10.0, 0.5))

    def enter(self, body: Body) -> None:
        """Add to the linear damping coefficients."""
        body.linear += self.values


class QuadraticDamping(Coefficients):
    """Separated flow behind a bluff body: a force that grows with the speed squared."""

    id = "quadratic_damping"
    equation = r"\tau_i = -d_i\,|\nu_{r,i}|\,\nu_{r,i}"
    neglects = "coupling between axes; valid above about 0.1 m/s"
    source = "Fossen 2021, sec. 6.4"
    cause = (
        "The hull drags more or less than the vehicle file says, mostly at high speed: a skirt, "
        "lamps, a gripper, an open frame."
    )
    revealed_by = (
        "Hold a quarter, half and all of the highest speed on one axis, 5 s each, and coast from "
        "each: doubling the speed takes four times the drag, with linear drag twice, and a weak "
        "thruster does not show while coasting."
    )
    signature = Signature({"sway": 120.0}, "sway", "sway speed")
    parameters = per_axis("N s2/m2", "N m s2/rad2", "d", scales=(40.0, 0.5))

    def enter(self, body: Body) -> None:
        """Add to the quadratic damping coefficients."""
        body.quadratic += self.values


class CubicDamping(Wrench):
    """Drag that grows with the third power of the speed, beyond the usual two terms."""

    id = "cubic_damping"
    equation = r"\tau_i = -c_i\,\nu_{r,i}^3"
    neglects = "coupling between axes"
    source = "Abkowitz 1964 (odd terms of a Taylor expansion)"
    cause = (
        "The drag was fitted at low speed and used at a higher one, or waves and ventilation add "
        "to it near the surface."
    )
    revealed_by = (
        "Hold a quarter, half and all of the highest speed on one axis, 5 s each, and coast from "
        "each: doubling the speed takes eight times the drag, with quadratic drag four times."
    )
    signature = Signature({"sway": 400.0}, "sway", "sway speed")
    parameters = per_axis("N s3/m3", "N m s3/rad3", "c", scales=(50.0, 0.5))

    @staticmethod
    def wrench(at, p):
        """Drag against the motion through the water along each axis."""
        u, v, w, a, b, c = at.nu_r
        return (
            -p.surge * u * u * u,
            -p.sway * v * v * v,
            -p.heave * w * w * w,
            -p.roll * a * a * a,
            -p.pitch * b * b * b,
            -p.yaw * c * c * c,
        )
