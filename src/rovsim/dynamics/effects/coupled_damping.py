"""Water resistance along one axis by motion along another."""

from rovsim.core.axes import AXES
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter, Signature

PAIRS = [(i, j) for i in range(6) for j in range(6) if i != j]
POWERS = (("", "d"), ("_quadratic", "d^q"))  # the rows of Body.coupling
# A tenth of what the diagonal terms of such a vehicle change by. First index: 0 force, 1 moment;
# second index: by 0 translation, 1 rotation.
SCALES = {(0, 0): 2.0, (0, 1): 0.5, (1, 0): 0.5, (1, 1): 0.1}


def _pair(i: int, j: int, suffix: str, symbol: str) -> Parameter:
    """The parameter of the force along axis i by motion along axis j."""
    power = "2" if suffix else ""
    force, unit = ("N", "N m")[i // 3], (f"s{power}/m{power}", f"s{power}/rad{power}")[j // 3]
    name = f"{AXES[i]}_from_{AXES[j]}{suffix}"
    scale = SCALES[i // 3, j // 3] * (4.0 if suffix else 1.0)  # equal drag at 0.25 m/s
    return Parameter(name, f"{force} {unit}", rf"{symbol}_{{{AXES[i]},{AXES[j]}}}", scale=scale)


class CoupledDamping(Coefficients):
    """An asymmetric hull resists motion along one axis with a force along another.

    One entry for every ordered pair, not mirrored: a coupling need not be dissipative.
    """

    id = "coupled_damping"
    equation = r"\tau_i = -d_{ij}\,\nu_{r,j} - d^q_{ij}\,|\nu_{r,j}|\,\nu_{r,j}"
    neglects = "products of velocities of different axes"
    source = "Fossen 2021, sec. 6.4 (off-diagonal terms of D)"
    cause = (
        "The hull is not symmetric: a lamp, a gripper or a bracket on one side, or drag above CO."
    )
    revealed_by = (
        "Drive one axis alone to a steady speed and coast: a coupling of the drag goes on turning "
        "or pushing the vehicle while it coasts, an unequal pair of thrusters stops doing so."
    )
    signature = Signature({"yaw_from_sway": 8.0}, "yaw", "sway speed")
    parameters = tuple(_pair(i, j, *power) for power in POWERS for i, j in PAIRS)

    def enter(self, body: Body) -> None:
        """Add to the damping between axes."""
        rows, columns = zip(*PAIRS, strict=True)
        for matrix, values in zip(body.coupling, self.values.reshape(2, -1), strict=True):
            matrix[list(rows), list(columns)] += values
