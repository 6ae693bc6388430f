"""Water resistance, axis by axis."""

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients
from rovsim.dynamics.effects.parameters import Signature, per_axis


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
