"""Moving water."""

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter
from rovsim.dynamics.effects.parameters import Signature


class Current(Coefficients):
    """A uniform and steady current; north is the x axis of the motion capture."""

    id = "current"
    equation = r"\nu_r = \nu - R^\top v_c"
    neglects = "shear, turbulence and anything unsteady"
    source = "Fossen 2021, sec. 10.3"
    cause = "A pump, an outlet, or the circulation that the vehicle itself has stirred up."
    revealed_by = (
        "Drift without commands at four headings for 20 s each: a current carries the vehicle to "
        "the same side until it moves with the water, a constant wrench turns with the body, a "
        "tether pulls harder with the distance."
    )
    signature = Signature({"north": 0.12}, "surge", "heading")
    parameters = tuple(
        Parameter(name, "m/s", f"v_{{{name}}}", scale=0.05) for name in ("north", "east", "down")
    )

    def enter(self, body: Body) -> None:
        """Add to the velocity of the water."""
        body.current += self.values
