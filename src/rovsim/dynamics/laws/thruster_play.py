"""Play between command and thrust: one of the laws that a diagnosis may propose."""

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Parameter, ThrusterDynamics


class ThrusterPlay(ThrusterDynamics):
    """The force of a thruster follows only once what is asked of it has moved by a band."""

    id = "thruster_play"
    listed = False
    equation = (
        r"F \leftarrow \min(\max(F,\ F_\text{static} - w),\ F_\text{static} + w),"
        r"\quad w = b + s\,|F_\text{static}|"
    )
    neglects = "that spinning up and down differ"
    source = "play operator (Krasnosel'skii & Pokrovskii 1989)"
    parameters = (
        Parameter("band", "N", "b", low=0.0, scale=1.0),
        Parameter("share", "1", "s", low=0.0, high=1.0, scale=0.1),
    )
    starts = ({"band": 0.5}, {"band": 2.0}, {"share": 0.1})

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """The play operator: at every step, clip the force before to the present band.

        Two clips in a row are again a clip, so all steps are evaluated together, by doubling.
        """
        F = force[0] if state is None else state
        values = self.given()
        band = values.get("band", 0.0) + values.get("share", 0.0) * np.abs(force)
        low, high, width = force - band, force + band, 1
        while width < len(force):
            bounds = low[width:].copy(), high[width:]
            low[width:] = np.clip(low[:-width], *bounds)
            high[width:] = np.clip(high[:-width], *bounds)
            width *= 2
        response = np.clip(F, low, high)
        return response, response[-1]
