"""Laws of how thrusters answer that the catalogue does not have; see `laws`.

They are evaluated step by step, as references for the laws that a diagnosis proposes.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Parameter, ThrusterDynamics

SPIN_UP_PARTS = 20  # of a step, in which a speed hardly changes


class Backlash(ThrusterDynamics):
    """Hysteresis of the thrusters: the force follows only once it has to move by a whole band."""

    id = "backlash"
    listed = False
    equation = r"F \leftarrow \min(\max(F, F_\text{static} - w), F_\text{static} + w)"
    neglects = "a band that grows with the force"
    source = "play operator (Krasnosel'skii & Pokrovskii 1989)"
    parameters = (Parameter("width", "N", "w", low=0.0, scale=2.0),)

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Apply the play operator step by step."""
        F = force[0] if state is None else state
        out, w = np.empty_like(force), self["width"]
        for row, static in zip(out, force, strict=True):
            F = np.clip(F, static - w, static + w)
            row[:] = F
        return out, F


class Slew(ThrusterDynamics):
    """Speed controllers that ramp the thrust: it changes at a limited rate."""

    id = "slew"
    listed = False
    equation = r"|\dot F| \le r"
    neglects = "a rate that depends on the thrust"
    source = "definition"
    parameters = (Parameter("rate", "N/s", "r", low=0.0, scale=30.0),)

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Change step by step."""
        F = force[0] if state is None else state
        if not self["rate"]:
            return force, force[-1]
        out, most = np.empty_like(force), self["rate"] * h
        for row, static in zip(out, force, strict=True):
            begin, F = F, F + np.clip(static - F, -most, most)
            row[:] = 0.5 * (begin + F)
        return out, F


class SpinUp(ThrusterDynamics):
    """Propellers spin up by a first order, and push with the square of their speed."""

    id = "spin_up"
    listed = False
    equation = r"T \dot n = n_\text{static} - n, \quad F = n |n|"
    neglects = "that spinning up and down differ"
    source = "Fossen 2021, sec. 9.4"
    parameters = (Parameter("time_constant", "s", "T", low=0.0, scale=0.15),)

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Change in small parts of each step."""
        wanted = np.sqrt(np.abs(force)) * np.sign(force)
        n = wanted[0] if state is None else state
        if not self["time_constant"]:
            return force, wanted[-1]
        out, share = np.zeros_like(force), h / SPIN_UP_PARTS / self["time_constant"]
        for row, to in zip(out, wanted, strict=True):
            for _ in range(SPIN_UP_PARTS):
                begin, n = n, n + (to - n) * -np.expm1(-share)
                row += 0.5 * (begin * np.abs(begin) + n * np.abs(n)) / SPIN_UP_PARTS
        return out, n
