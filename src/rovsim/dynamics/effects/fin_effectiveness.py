"""Rudders and fins that lift less than they should."""

from functools import cache

import numpy as np

from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.base import Actuated, Coefficients, Effect, Parameter, Signature


def _gain(name: str) -> Parameter:
    return Parameter(name, "1", rf"g_\text{{{name}}}", default=1.0, scale=0.1)


class FinEffectiveness(Coefficients):
    """Control surfaces lift more or less than the vehicle file says.

    A parameter for each surface of the vehicle, by its name, and one for all.
    """

    id = "fin_effectiveness"
    rank = 1
    requires = "surfaces"
    equation = r"L \to g\,g_i\,L"
    symbols = (
        ("L", "lift of control surface i"),
        ("g", "factor of all"),
        ("g_i", "factor of surface i"),
    )
    neglects = "a change of its drag, of its stall and of its zero"
    source = "definition"
    cause = (
        "A fin is bent, fouled or of another size, stands in the hull's wake, or its horn slips."
    )
    revealed_by = (
        "Step one surface at a time at two speeds: lift of a fin grows with the square of the "
        "speed and turns with the angle, lift of the hull needs no command."
    )
    signature = Signature({"all": 0.6}, "yaw", "yaw rate")
    parameters = (_gain("all"),)

    @classmethod
    def on(cls, vehicle: Actuated) -> type[Effect]:
        """With a factor for each surface of the vehicle, by its name."""
        return _of(vehicle.surface_names)

    def enter(self, body: Body) -> None:
        """Scale the lift of each surface, in the vehicle file's order."""
        factors = np.append(self.values[:-1], np.ones(len(body.lifting)))[: len(body.lifting)]
        body.lifting = body.lifting * factors * self["all"]


@cache
def _of(names: tuple[str, ...]) -> type[FinEffectiveness]:
    """The effect with a factor for each of these surfaces, and the common one, `all`."""
    return FinEffectiveness.adapted(parameters=(*(_gain(name) for name in names), _gain("all")))
