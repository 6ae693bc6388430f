"""Gains on the pilot's demands before the mixer."""

from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.dynamics.effects.base import DemandTransform, Parameter, Signature


class PilotGain(DemandTransform):
    """A gain between the logged demand and the mixer: the autopilot gives more or less of it."""

    id = "pilot_gain"
    differs_between_runs = True
    equation = r"\text{demand}_i \to g_i\,\text{demand}_i"
    neglects = "exponential sticks and dead zones, and demands that a loop on board takes"
    source = "definition"
    cause = "A gain of the sticks was set in the ground station, and the log holds the stick alone."
    revealed_by = (
        "Push one axis at a time for 3 s at the same demand and coast: a gain of the pilot scales "
        "one axis and no other, a weak thruster also pushes along others."
    )
    signature = Signature({"surge": 0.6}, "surge", "surge thrust")
    parameters = tuple(
        Parameter(axis, "1", rf"g_{{{axis}}}", default=1.0, scale=0.1) for axis in AXES
    )

    def mixer_demand(self, demand: Array) -> Array:
        """Each demand times its gain."""
        return demand * self.values
