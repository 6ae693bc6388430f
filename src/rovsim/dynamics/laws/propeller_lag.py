"""Propellers that take time to change their speed: a law that a diagnosis may propose."""

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.compilation.compiled import kept
from rovsim.dynamics.effects.base import Parameter, ThrusterDynamics


@kept
def lag_speed(wanted: Array, h: float, lag: float, start: Array) -> tuple[Array, Array]:
    """Let speeds n follow by a first order, and square them.

    Args:
        wanted: (k, n), constant over each of k steps.
        h: a step, s.
        lag: time constant, s; above 0.
        start: (n,) before the first step.

    Returns:
        Means of n |n| over the steps (k, n), exact, and the speeds (n,) after the last one.
    """
    mean, value = np.empty_like(wanted), start.copy()
    for k in range(len(wanted)):
        for i in range(len(value)):
            to, n, total = wanted[k, i], value[i], 0.0
            slowing = min(lag * np.log1p(-n / to), h) if n * to < 0.0 else 0.0  # until it turns
            for time in (slowing, h - slowing):
                off, gone = n - to, 1.0 - np.exp(-time / lag)
                squares = to * to * time + off * lag * (2.0 * to + off * (1.0 - 0.5 * gone)) * gone
                begun, n = n, n - off * gone
                total += np.sign(begun + n) * squares
            mean[k, i], value[i] = total / h, n
    return mean, value


class PropellerLag(ThrusterDynamics):
    """A propeller's speed follows by a first order; its force is the square of the speed."""

    id = "propeller_lag"
    listed = False
    equation = (
        r"T\,\dot n + n = n_\text{static},"
        r"\quad F = n\,|n|,\quad F_\text{static} = n_\text{static}\,|n_\text{static}|"
    )
    neglects = "that spinning up and down differ"
    source = "Fossen 2021, sec. 9.4 (first-order actuator; thrust is quadratic in the speed)"
    parameters = (Parameter("time_constant", "s", "T", low=0.0, scale=0.1),)
    starts = ({"time_constant": 0.05}, {"time_constant": 0.2})

    def respond(self, force: Array, h: float, state: Array | None) -> tuple[Array, Array]:
        """Let the signed root of the force follow."""
        n, lag = np.sign(force) * np.sqrt(np.abs(force)), self["time_constant"]
        if not lag:
            return force, n[-1]
        return lag_speed(n, h, lag, n[0] if state is None else state)
