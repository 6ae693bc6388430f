"""What pushes the true vehicle and nobody logs, and other noise that lasts."""

from itertools import accumulate

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Wander
from rovsim.dynamics.model import Model
from rovsim.simulation.synthetic_tank.settings import Turbulence


def draw_turbulence(
    settings: Turbulence, steps: int, h: float, random: np.random.Generator
) -> Array:
    """Gauss-Markov wrench (steps, 6) in body axes over steps of h s, stationary from the start."""
    level = np.repeat([settings.force, settings.moment], 3)
    return draw_gauss_markov(steps, h / settings.time_constant, random) * level


def draw_currents(model: Model, ticks: int, dt: float, random: np.random.Generator) -> Array:
    """Current (ticks, 3) m/s in NED that wanders, drawn by generators of its own."""
    wandering = [effect for effect in model.effects if isinstance(effect, Wander)]
    found = np.zeros((ticks, 3))
    for effect, own in zip(wandering, random.spawn(len(wandering)), strict=True):
        found += effect.draw(ticks, dt, own)
    return found


def draw_gauss_markov(steps: int, step: float, random: np.random.Generator) -> Array:
    """Six channels (steps, 6) of unit variance, stationary; `step` in time constants."""
    a = float(np.exp(-step))
    kicks = random.normal(size=(steps, 6)) * np.sqrt(1.0 - a * a)
    return kept_in_part(a, kicks, random.normal(size=6))


def kept_in_part(a: float, kicks: Array, begin: Array) -> Array:
    """x = a x + kick, row by row of the kicks (n, c), from x = begin (c,) on."""
    # In Python's floats: faster than rows of NumPy, and SciPy's filter takes a second to import.
    columns = zip(begin.tolist(), kicks.T.tolist(), strict=True)
    found = [accumulate(column, lambda x, kick: a * x + kick, initial=x) for x, column in columns]
    return np.ascontiguousarray(np.transpose([list(one)[1:] for one in found]))
