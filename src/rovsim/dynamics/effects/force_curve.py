"""The shape of the thrusters' static force curve."""

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Parameter, Signature, ThrustCurveShape


class CurveExponent(ThrustCurveShape):
    """Thrusters whose curve is more bent, or straighter, than the published one.

    The force at full command stays; below 1 small commands push more, above 1 less.
    """

    id = "force_curve"
    equation = r"F \to \mathrm{sign}(F)\,F_\text{max}\,(|F| / F_\text{max})^e"
    symbols = ((r"F_\text{max}", "force at full command"),)
    neglects = "another force at full command: that is a gain"
    source = "definition"
    cause = (
        "The speed controllers turn commands into speeds by another curve than in the published "
        "test, or the propellers are not those that were tested."
    )
    revealed_by = (
        "Hold a tenth, a quarter, half and all of full thrust on one axis until the speed is "
        "steady: a curve errs most at the small ones and not at full thrust, a gain equally at all."
    )
    signature = Signature({"exponent": 1.4}, "surge", "surge thrust")
    # at a tenth of full force a change of 0.1 is a fifth of the force: 0.1^0.1 = 0.8
    parameters = (Parameter("exponent", "1", "e", low=0.1, default=1.0, scale=0.1),)

    def reshaped_force(self, force: Array, full: Array) -> Array:
        """Raise the ratio to the full force to a power."""
        limit = np.abs(np.where(force < 0.0, full[0], full[1]))
        share = np.divide(np.abs(force), limit, out=np.zeros_like(force), where=limit > 0.0)
        return np.sign(force) * limit * share ** self["exponent"]
