"""Buoyancy: how much, and where it acts."""

from rovsim.body import Body
from rovsim.effects.base import Coefficients, Parameter


class NetBuoyancy(Coefficients):
    """Extra buoyancy at the (moved) centre of buoyancy: foam, trapped air, salt."""

    id = "net_buoyancy"
    equation = r"B \mathrel{+}= \Delta B"
    neglects = "the mass of what floats"
    source = "Fossen 2021, sec. 4.1"
    parameters = (Parameter("force", "N", r"\Delta B", scale=2.0),)

    def enter(self, body: Body) -> None:
        """Add to the buoyancy."""
        body.buoyancy += self["force"]


class BuoyancyCenter(Coefficients):
    """The centre of buoyancy is elsewhere: it sets how stiffly the vehicle rights itself."""

    id = "buoyancy_center"
    equation = r"r_B \mathrel{+}= \Delta r_B"
    neglects = "compression with depth"
    source = "Fossen 2021, sec. 4.1"
    # centimetres: the vehicle's own righting arm is 10 mm (vehicle file)
    parameters = tuple(Parameter(axis, "m", rf"\Delta {axis}_B", scale=0.005) for axis in "xyz")

    def enter(self, body: Body) -> None:
        """Move the centre of buoyancy."""
        body.center_of_buoyancy = body.center_of_buoyancy + self.values
