"""Moving water."""

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Coefficients, Parameter, Signature, StochasticCurrent


class Current(Coefficients):
    """A uniform and steady current; north is the x axis of the motion capture."""

    id = "current"
    differs_between_runs = True
    equation = r"\nu_r = \nu - R^\top v_c"
    symbols = (("v_c", "velocity of the water north, east, down"),)
    neglects = "shear, turbulence and anything unsteady"
    source = "Fossen 2021, sec. 10.3"
    cause = "A pump, an outlet, or the circulation that the vehicle itself has stirred up."
    revealed_by = (
        "Drift without commands at four headings for 20 s each: a current carries the vehicle to "
        "the same side until it moves with the water, a constant wrench turns with the body, a "
        "tether pulls harder with the distance."
    )
    telling = ("north", "east")  # water that rises is no current
    signature = Signature({"north": 0.12}, "surge", "heading")
    parameters = tuple(
        Parameter(name, "m/s", f"v_{{{name}}}", scale=0.05) for name in ("north", "east", "down")
    )

    def enter(self, body: Body) -> None:
        """Add to the velocity of the water."""
        body.current += self.values


class CurrentDrift(StochasticCurrent):
    """The current wanders, from still water on, north and east.

    A model has the mean of it, which is still water, so it adds nothing to a replay. The synthetic
    tank draws one of the many ways it may go.
    """

    id = "current_drift"
    equation = (
        r"v_c(t + \Delta t) = v_c(t) + r \sqrt{\Delta t}\,\xi,\quad \xi \sim \mathcal{N}(0, 1)"
    )
    symbols = (
        ("v_c", "velocity of the water"),
        (r"\Delta t", "a step of time"),
        (r"\xi", "a random number"),
        (r"\mathcal{N}(0, 1)", "the standard normal distribution"),
    )
    neglects = "that water calms down again, the vertical, and the force of water that accelerates"
    source = "limit of the Gauss-Markov process of Fossen 2021, sec. 10.3, without decay"
    cause = "A pump that is switched, circulation that vehicles stir up, or tides, wind and waves."
    revealed_by = (
        "Drift without commands for 20 s at the start, in the middle and at the end of a long "
        "run: each time the water carries the vehicle elsewhere, a steady current always alike."
    )
    signature = Signature({"rate": 0.012}, "surge", "time in the run", size=True)
    parameters = (  # the scale grows to that of a current, 0.05 m/s, in a minute
        Parameter("rate", "m/s per sqrt(s)", "r", low=0.0, scale=0.006),
    )

    def draw(self, ticks: int, dt: float, random: np.random.Generator) -> Array:
        """A random walk of the horizontal velocity."""
        steps = self["rate"] * np.sqrt(dt) * random.normal(size=(ticks, 3))
        return np.cumsum(steps * [1.0, 1.0, 0.0], axis=0)
