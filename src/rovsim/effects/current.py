"""Moving water."""

from rovsim.body import Body
from rovsim.effects.base import Coefficients, Parameter


class Current(Coefficients):
    """A uniform and steady current; north is the x axis of the motion capture."""

    id = "current"
    equation = r"\nu_r = \nu - R^\top v_c"
    neglects = "shear, turbulence and anything unsteady"
    source = "Fossen 2021, sec. 10.3"
    parameters = tuple(
        Parameter(name, "m/s", f"v_{name[0]}", scale=0.05) for name in ("north", "east", "down")
    )

    def enter(self, body: Body) -> None:
        """Add to the velocity of the water."""
        body.current += self.values
