"""Limits on how fast thrust changes: laws that a diagnosis may propose.

Speed controllers ramp what they are asked for, lest the current trips them.
"""

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.compilation.compiled import kept
from rovsim.dynamics.effects.base import Parameter, ThrusterDynamics


@kept
def limit_rate(wanted: Array, h: float, ramp: float, start: Array) -> tuple[Array, Array]:
    """Follow what is wanted at a limited rate.

    Args:
        wanted: (k, n), constant over each of k steps.
        h: a step, s.
        ramp: time, s, that a change by one takes; 0 for none.
        start: (n,) before the first step.

    Returns:
        Means over the steps (k, n), exact, and the values (n,) at the end of the last one.
    """
    mean, value = np.empty_like(wanted), start.copy()
    for k in range(len(wanted)):
        for i in range(len(value)):
            gap = wanted[k, i] - value[i]
            arrival = ramp * abs(gap)
            if arrival <= h:  # then it stays
                mean[k, i] = wanted[k, i] - 0.5 * gap * arrival / h
                value[i] = wanted[k, i]
            else:
                step = gap * h / arrival
                mean[k, i] = value[i] + 0.5 * step
                value[i] += step
    return mean, value


class ThrustRate(ThrusterDynamics):
    """The force of a thruster changes at a limited rate: a newton takes the time a."""

    id = "thrust_rate"
    listed = False
    equation = r"a\,\dot F = \operatorname{sign}(F_\text{static} - F)"
    neglects = "that spinning up and down differ"
    source = "definition"
    parameters = (Parameter("ramp", "s/N", "a", low=0.0, scale=0.05),)
    starts = ({"ramp": 0.02}, {"ramp": 0.08})

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Let the force follow by a newton in the time that one takes."""
        return limit_rate(force, h, self["ramp"], force[0] if state is None else state)


class PropellerRate(ThrusterDynamics):
    """A propeller's speed changes at a limited rate; its force is the square of the speed."""

    id = "propeller_rate"
    listed = False
    equation = (
        r"a\,\dot n = \operatorname{sign}(n_\text{static} - n),"
        r"\quad F = n\,|n|,\quad F_\text{static} = n_\text{static}\,|n_\text{static}|"
    )
    neglects = "that spinning up and down differ, and how the speed changes within a step"
    source = "definition; Fossen 2021, sec. 9.4 (thrust is quadratic in the propeller's speed)"
    parameters = (Parameter("ramp", "s/N^0.5", "a", low=0.0, scale=0.2),)
    starts = ({"ramp": 0.08}, {"ramp": 0.3})

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Let the signed root of the force follow."""
        n = np.sign(force) * np.sqrt(np.abs(force))
        mean, last = limit_rate(n, h, self["ramp"], n[0] if state is None else state)
        return (mean * np.abs(mean), last) if self["ramp"] else (force, n[-1])
