"""A fluid memory with a coefficient for each axis: one of the laws that a diagnosis may propose."""

import numpy as np

from rovsim.core.axes import AXES
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter


class WakeByAxis(Coefficients):
    """Water that an axis has set moving goes on pushing it: a drag on changes of speed that fades.

    As `fluid_memory`, but for each axis by itself.
    """

    id = "wake_by_axis"
    listed = False
    equation = r"\tau_i = -c_i\,(\nu_{r,i} - m_i),\quad T \dot m = \nu_r - m"
    neglects = "more than one time constant, and how an axis' wake pushes another"
    source = "Fossen 2021, sec. 6.2 (fluid memory), reduced to one state an axis"
    parameters = (
        *(Parameter(axis, "N s/m", f"c_{axis}", low=0.0, scale=5.0) for axis in AXES[:3]),
        *(Parameter(axis, "N m s/rad", f"c_{axis}", low=0.0, scale=0.1) for axis in AXES[3:]),
        Parameter("time_constant", "s", "T", low=0.05, high=30.0, default=1.0, scale=0.5),
    )
    starts = tuple({"time_constant": T} for T in (0.3, 1.0, 3.0))

    def enter(self, body: Body) -> None:
        """Add the fluid memory to the body, if a coefficient is not 0."""
        coefficients = self.given()
        memory = np.array([coefficients.get(axis, 0.0) for axis in AXES])
        if memory.any():
            body.remember(memory, self["time_constant"])
