"""Random wrenches on the true vehicle and random currents, which are not logged."""

from copy import deepcopy
from typing import Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.core import gauss_markov
from rovsim.dynamics.effects.base import StochasticCurrent
from rovsim.dynamics.model import Model
from rovsim.simulation.synthetic_tank.settings import Turbulence


def draw_turbulence(
    settings: Turbulence, steps: int, h: float, random: np.random.Generator, rows: int
) -> Iterator[Array]:
    """Draw a stationary Gauss-Markov wrench in body axes, N and N m.

    `random` has made all its draws when this returns, before the first rows are computed.

    Args:
        settings: standard deviations and time constant.
        steps: number of integration steps.
        h: their length, s.
        random: generator.
        rows: number of steps of each array.

    Returns:
        Arrays (rows, 6), of which the last may be shorter, one after the other.
    """
    level = np.repeat([settings.force, settings.moment], 3)
    lengths = [min(rows, steps - first) for first in range(0, steps, rows)]
    replayed = deepcopy(random)
    for length in lengths:  # how each run begins is drawn last
        random.normal(size=(length, 6))
    a = gauss_markov.decay(h / settings.time_constant)
    return _draw_wrenches(lengths, a, level, replayed, random.normal(size=6))


def _draw_wrenches(
    lengths: list[int], a: Array, level: Array, random: np.random.Generator, begin: Array
) -> Iterator[Array]:
    """Yield wrenches (length, 6), each continuing the process where the last one ended."""
    for length in lengths:
        wrenches = gauss_markov.propagate(a, random.normal(size=(length, 6)), begin)
        begin = wrenches[-1]
        yield wrenches * level


def draw_currents(model: Model, ticks: int, dt: float, random: np.random.Generator) -> Array:
    """Draw the sum (ticks, 3) of a model's random currents, m/s NED, at ticks dt s apart.

    Each current has a generator of its own, so that other draws do not depend on it.
    """
    effects = [effect for effect in model.effects if isinstance(effect, StochasticCurrent)]
    current = np.zeros((ticks, 3))
    for effect, generator in zip(effects, random.spawn(len(effects)), strict=True):
        current += effect.draw(ticks, dt, generator)
    return current
