"""Water that has to be accelerated with the vehicle."""

import numpy as np

from rovsim.body import Body
from rovsim.effects.base import Coefficients, per_axis


class AddedMass(Coefficients):
    """Diagonal added mass; its Coriolis terms follow."""

    id = "added_mass"
    equation = r"\tau = -M_A\dot\nu_r - C_A(\nu_r)\nu_r"
    neglects = "coupling between axes and frequency dependence"
    source = "Fossen 2021, sec. 6.3"
    parameters = per_axis("kg", "kg m2", "m_A")

    def enter(self, body: Body) -> None:
        """Add to the diagonal of M_A."""
        body.M_A += np.diag(self.values)
