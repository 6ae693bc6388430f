"""Play between command and thrust: one of the laws that a diagnosis may propose."""

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Parameter, Response


class ThrusterPlay(Response):
    """The force of a thruster follows only once what is asked of it has moved by a band."""

    id = "thruster_play"
    listed = False
    equation = r"F \leftarrow \min(\max(F,\ F_\text{static} - w),\ F_\text{static} + w)"
    neglects = "a band that grows with the force"
    source = "play operator (Krasnosel'skii & Pokrovskii 1989)"
    parameters = (Parameter("band", "N", "w", low=0.0, scale=1.0),)
    starts = ({"band": 0.5}, {"band": 2.0})

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """The play operator, step by step."""
        F, w = force[0] if state is None else state, self["band"]
        found = np.empty_like(force)
        for k in range(len(force)):
            F = np.clip(F, force[k] - w, force[k] + w)
            found[k] = F
        return found, F
