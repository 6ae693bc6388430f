"""Water that still moves as the vehicle did a moment ago."""

import numpy as np

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter, Signature

SQUARED_ARM = 0.02  # kappa, m2: square of the arm at which rotation meets the water; a convention
WEIGHTS = np.array([1.0, 1.0, 1.0, SQUARED_ARM, SQUARED_ARM, SQUARED_ARM])


class FluidMemory(Coefficients):
    """The wake takes time to form: a drag on changes of speed that fades as the water follows.

    m is the velocity that the water remembers, zero at the start of the recording.
    """

    id = "fluid_memory"
    equation = (
        r"\tau = -c\,\mathrm{diag}(1,1,1,\kappa,\kappa,\kappa)(\nu_r - m),"
        r"\quad T \dot m = \nu_r - m"
    )
    symbols = (
        ("m", "velocity that the water remembers"),
        (r"\dot m", "rate of change of m"),
        (r"\kappa", "0.02 m²"),
    )
    neglects = "more than one time constant, and waves"
    source = "Fossen 2021, sec. 6.2 (fluid memory), reduced to one state an axis"
    cause = (
        "The wake goes on moving when the vehicle slows down or turns back, most of all in a "
        "small tank."
    )
    revealed_by = (
        "Hold a steady speed for 5 s, stop within 1 s and then wait 5 s without commands: the "
        "wake goes on pushing for about its time constant, added mass and a thruster lag do not."
    )
    signature = Signature({"coefficient": 30.0, "time_constant": 1.0}, "surge", "surge thrust")
    parameters = (
        Parameter("coefficient", "N s/m", "c", low=0.0, scale=5.0),
        Parameter("time_constant", "s", "T", low=0.01, default=1.0, scale=0.5),
    )
    starts = tuple({"coefficient": 5.0, "time_constant": T} for T in (0.2, 0.8, 3.0))

    def enter(self, body: Body) -> None:
        """Add the fluid memory to the body."""
        if self["coefficient"]:
            body.remember(self["coefficient"] * WEIGHTS, self["time_constant"])
