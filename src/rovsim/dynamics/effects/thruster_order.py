"""Two outputs of the autopilot that are swapped."""

from dataclasses import replace
from functools import cache
from itertools import combinations
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Actuated, CommandTransform, Effect, Parameter, Signature


class ThrusterOrder(CommandTransform):
    """Two outputs are swapped: each of two thrusters does what the log says of the other.

    Numbers from 1, in the vehicle file's order; they are tried, not fitted. 0: nothing is swapped.
    """

    id = "thruster_order"
    rank = -1  # before a dead band
    equation = r"c_i \leftrightarrow c_j"
    symbols = (
        ("c_i", "command of output i"),
        ("c_j", "command of output j"),
    )
    neglects = "more than two outputs in another order"
    source = "definition"
    cause = "Two cables are swapped, or the log counts the outputs in another order than the file."
    revealed_by = (
        "Run one thruster at a time, 1 s each, at rest: the first acceleration says where it sits "
        "and which way it pushes."
    )
    signature = Signature({"first": 5.0, "second": 7.0}, "pitch", "pitch thrust")
    parameters = tuple(
        Parameter(name, "1", symbol, low=0.0, scale=1.0, fitted=False, discrete=True)
        for name, symbol in (("first", "i"), ("second", "j"))
    )
    starts = ({"first": 1.0, "second": 2.0},)

    @classmethod
    def describe(cls, value: float, names: Sequence[str]) -> str:
        """Describe an output by its number and its thruster, the one of `names` in that place."""
        k = int(value)
        return f"{k} ({names[k - 1]})" if 0 < k <= len(names) else f"{k}"

    @classmethod
    def on(cls, vehicle: Actuated) -> type[Effect]:
        """With all pairs of the vehicle's thrusters as starts."""
        return _among(vehicle.thruster_count)

    def thruster_command(self, command: Array) -> Array:
        """Swap the two columns."""
        count = command.shape[1]
        i, j = (int(k) for k in self.values)
        if not (0 < i <= count and 0 < j <= count):
            return command
        order = np.arange(count)
        order[[i - 1, j - 1]] = order[[j - 1, i - 1]]
        return command[:, order]


@cache
def _among(count: int) -> type[ThrusterOrder]:
    """The effect with all pairs of so many thrusters as starts."""
    pairs = combinations(range(1, count + 1), 2)
    starts = tuple({"first": float(i), "second": float(j)} for i, j in pairs)
    parameters = tuple(replace(p, most=float(count)) for p in ThrusterOrder.parameters)
    return ThrusterOrder.adapted(starts=starts or ThrusterOrder.starts, parameters=parameters)
