"""Buoyancy: how much, and where it acts."""

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter, Signature


class NetBuoyancy(Coefficients):
    """Extra buoyancy at the (moved) centre of buoyancy: foam, trapped air, salt."""

    id = "net_buoyancy"
    differs_between_runs = True
    equation = r"B \to B + \Delta B"
    symbols = (("B", "buoyancy"),)
    neglects = "the mass of what floats"
    source = "Fossen 2021, sec. 4.1"
    cause = "Foam was added, air is trapped, or the water is denser than the vehicle file says."
    revealed_by = (
        "Stop the thrusters and let it rise or sink, level and then leaning by 30 degrees: "
        "buoyancy always pushes up, a constant wrench leans with the body, and a payload adds "
        "inertia as well."
    )
    signature = Signature({"force": 4.0}, "heave", "depth below the surface")
    parameters = (Parameter("force", "N", r"\Delta B", scale=2.0),)

    def enter(self, body: Body) -> None:
        """Add to the buoyancy."""
        body.buoyancy += self["force"]


class BuoyancyCenter(Coefficients):
    """The centre of buoyancy is elsewhere: it sets how stiffly the vehicle rights itself."""

    id = "buoyancy_center"
    differs_between_runs = True
    equation = r"r_B \to r_B + \Delta r_B"
    symbols = (
        ("r_B", "centre of buoyancy"),
        (r"\Delta r_B", "its shift x, y, z"),
    )
    neglects = "compression with depth"
    source = "Fossen 2021, sec. 4.1"
    cause = (
        "Foam, battery or ballast was moved: the vehicle trims at another angle and rights itself "
        "more or less stiffly."
    )
    revealed_by = (
        "Hold roll and pitch at several angles to both sides, 5 s each: a moved centre makes a "
        "moment that changes with the angle, a constant moment stays the same at all of them."
    )
    signature = Signature({"z": -0.02}, "roll", "roll angle")
    # centimetres: the vehicle's own righting arm is 10 mm (vehicle file)
    parameters = tuple(Parameter(axis, "m", rf"\Delta {axis}_B", scale=0.005) for axis in "xyz")

    def enter(self, body: Body) -> None:
        """Move the centre of buoyancy."""
        body.center_of_buoyancy = body.center_of_buoyancy + self.values
