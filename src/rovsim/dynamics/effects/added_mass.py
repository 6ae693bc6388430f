"""Water that has to be accelerated with the vehicle."""

import numpy as np

from rovsim.core.axes import AXES
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter, Signature, per_axis

PAIRS = [(i, j) for i in range(6) for j in range(i + 1, 6)]
UNITS = ("kg", "kg m", "kg m2")  # of an entry, by how many of its two axes are rotations
SCALES = (1.0, 0.2, 0.05)  # 1 kg displaced by 0.2 m; its moment of inertia there


class AddedMass(Coefficients):
    """Diagonal added mass; its Coriolis terms follow."""

    id = "added_mass"
    equation = r"\tau = -M_A\dot\nu_r - C_A(\nu_r)\nu_r"
    symbols = (
        ("M_A", "added mass, with the values on its diagonal"),
        ("C_A", "its Coriolis matrix"),
        (r"\dot\nu_r", "acceleration through the water"),
    )
    neglects = "coupling between axes and frequency dependence"
    source = "Fossen 2021, sec. 6.3"
    cause = (
        "The frame takes more or less water along than the vehicle file says: panels, skirts, nets."
    )
    revealed_by = (
        "Step one axis from rest to full thrust and hold it 5 s: added mass slows the rise and "
        "leaves the final speed alone, drag changes the final speed, and a lag no longer shows "
        "once the thrust is steady."
    )
    signature = Signature({"surge": 8.0}, "surge", "surge acceleration")
    parameters = per_axis("kg", "kg m2", "m", scales=(3.0, 0.1))

    def enter(self, body: Body) -> None:
        """Add to the diagonal of M_A."""
        body.M_A += np.diag(self.values)


class AddedMassCoupling(Coefficients):
    """Water accelerated along one axis pushes along another; its Coriolis terms follow."""

    id = "added_mass_coupling"
    equation = r"M_{A,ij} = M_{A,ji} \to M_{A,ij} + m_{ij}"
    symbols = (
        ("M_{A,ij}", "entry of the matrix of added mass"),
        ("M_{A,ji}", "its mirror image"),
    )
    neglects = "frequency dependence"
    source = "Fossen 2021, sec. 6.3 (M_A is symmetric)"
    cause = (
        "The water that is taken along has its centre away from CO: a hull with more area ahead, "
        "or on top."
    )
    revealed_by = (
        "Push one axis to and fro every second at low speed: a coupling of masses moves the other "
        "axis in step with the acceleration, coupled damping in step with the speed."
    )
    signature = Signature({"surge_pitch": 1.0}, "pitch", "surge acceleration")
    parameters = tuple(
        Parameter(
            f"{AXES[i]}_{AXES[j]}",
            UNITS[i // 3 + j // 3],
            f"m_{{{AXES[i]},{AXES[j]}}}",
            scale=SCALES[i // 3 + j // 3],
        )
        for i, j in PAIRS
    )

    def enter(self, body: Body) -> None:
        """Add to both sides of the diagonal of M_A."""
        for (i, j), value in zip(PAIRS, self.values, strict=True):
            body.M_A[i, j] += value
            body.M_A[j, i] += value
