"""What pushes the true vehicle and nobody logs, and other noise that lasts."""

from copy import deepcopy
from itertools import accumulate
from typing import Iterator

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Wander
from rovsim.dynamics.model import Model
from rovsim.simulation.synthetic_tank.settings import Turbulence


def draw_turbulence(
    settings: Turbulence, steps: int, h: float, random: np.random.Generator, rows: int
) -> Iterator[Array]:
    """Gauss-Markov wrench (steps, 6) in body axes over steps of h s, stationary from the start.

    It comes `rows` at a time, and is drawn at once: `random` has moved on when this returns.
    """
    level = np.repeat([settings.force, settings.moment], 3)
    lengths = [min(rows, steps - first) for first in range(0, steps, rows)]
    again = deepcopy(random)
    for length in lengths:  # how each run begins is drawn last
        random.normal(size=(length, 6))
    return _pushes(lengths, h / settings.time_constant, level, again, random.normal(size=6))


def _pushes(
    lengths: list[int], step: float, level: Array, random: np.random.Generator, begin: Array
) -> Iterator[Array]:
    for length in lengths:
        found = _gauss_markov(step, random.normal(size=(length, 6)), begin)
        begin = found[-1]
        yield found * level


def draw_currents(model: Model, ticks: int, dt: float, random: np.random.Generator) -> Array:
    """Current (ticks, 3) m/s in NED that wanders, drawn by generators of its own."""
    wandering = [effect for effect in model.effects if isinstance(effect, Wander)]
    found = np.zeros((ticks, 3))
    for effect, own in zip(wandering, random.spawn(len(wandering)), strict=True):
        found += effect.draw(ticks, dt, own)
    return found


def draw_gauss_markov(steps: int, step: float, random: np.random.Generator) -> Array:
    """Six channels (steps, 6) of unit variance, stationary; `step` in time constants."""
    kicks = random.normal(size=(steps, 6))
    return _gauss_markov(step, kicks, random.normal(size=6))


def _gauss_markov(step: float, kicks: Array, begin: Array) -> Array:
    """Goes on from `begin` (6,), by kicks (steps, 6) of unit variance."""
    a = float(np.exp(-step))
    return kept_in_part(a, kicks * np.sqrt(1.0 - a * a), begin)


def kept_in_part(a: float, kicks: Array, begin: Array) -> Array:
    """x = a x + kick, row by row of the kicks (n, c), from x = begin (c,) on."""
    # In Python's floats: faster than rows of NumPy, and SciPy's filter takes a second to import.
    found = np.empty_like(kicks)
    for c, x in enumerate(begin.tolist()):
        column = accumulate(kicks[:, c].tolist(), lambda x, kick: a * x + kick, initial=x)
        next(column)
        found[:, c] = np.fromiter(column, float, len(kicks))
    return found
