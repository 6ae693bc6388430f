"""From a logged command to the static force of each thruster (order: docs/simulator.md)."""

from typing import Any, Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.benchmarks.blind.independent.vehicle import Hidden


class Thrusters:
    """Forces of the thrusters by command, and when commands act.

    Attributes:
        limit: of the absolute command.
        mixer: matrix (n, 6) from demands to commands.
        curve: force in N of a command in [-1, 1].
        full: forces at the commands 1 and -1, N, both positive.
        hidden: parameters of the hidden effects.
        seconds: duration of the run.
        gain: factor (n,) of each thruster's force.
    """

    def __init__(self, file: Mapping[str, Any], hidden: Hidden, seconds: float) -> None:
        section = file["thrusters"]
        self.limit = float(section.get("command_limit", 1.0))
        self.mixer = np.array(list(section["mixer"].values()), float).T
        coefficients = section["force_curve"]["odd_polynomial"]
        # a_0 c + a_1 c^3 + …: every second coefficient of a polynomial
        self.curve = np.polynomial.Polynomial([x for a in coefficients for x in (0.0, float(a))])
        self.full = float(self.curve(1.0)), float(-self.curve(-1.0))
        self.hidden, self.seconds = hidden, seconds
        self.gain = self._gains(len(section["units"]))

    def _gains(self, count: int) -> Array:
        gains = self.hidden.get("thruster_gain", {})
        return gains.get("all", 1.0) * np.array(
            [gains.get(f"t{i}", 1.0) for i in range(1, count + 1)]
        )

    def command(self, demand: Array) -> Array:
        """Return the commands (n,) to a demand (6,), rounded as a log in whole microseconds is."""
        return np.round(400.0 * np.clip(self.mixer @ demand, -self.limit, self.limit)) / 400.0

    def force(self, command: Array) -> Array:
        """Return the static forces (n,) to commands (n,), N, with a full battery."""
        width = self.hidden.get("thruster_deadband", {}).get("width", 0.0)
        force = self.curve(np.where(np.abs(command) > width, command, 0.0))
        exponent = self.hidden.get("force_curve", {}).get("exponent", 1.0)
        if exponent != 1.0:
            full = np.where(force > 0.0, *self.full)
            force = np.sign(force) * full * (np.abs(force) / full) ** exponent
        ratio = self.hidden.get("thrust_asymmetry", {}).get("ratio", 1.0)
        force = force * self.gain
        return np.where(force < 0.0, ratio * force, force)

    def battery(self, t: float) -> float:
        """Return the share of each force that the battery leaves after t seconds."""
        sag = self.hidden.get("voltage_sag", {})
        share, rate = sag.get("fraction", 0.0) / self.seconds, sag.get("rate", 0.0)
        return max(0.0, 1.0 - (share + rate) * t)

    def log(self, t: float) -> tuple[float, float]:
        """Return the logged time of a command given at t, and the time from which it acts, s.

        The clock of the commands runs at 1 + rate, and a line acts `delay` after its stamp. No
        command acts before it is given; where clock and delay would have it so, the stamp is later.
        """
        pace = 1.0 + self.hidden.get("clock_drift", {}).get("rate", 0.0)
        delay = self.hidden.get("input_delay", {}).get("delay", 0.0)
        acts = t / pace + delay
        return (t, acts) if acts >= t else ((t - delay) * pace, t)
