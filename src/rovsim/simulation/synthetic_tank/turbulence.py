"""What pushes the true vehicle and nobody logs, and other noise that lasts."""

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
    a = np.exp(-step)
    kicks = random.normal(size=(steps, 6)) * np.sqrt(1.0 - a * a)
    found, x = np.empty((steps, 6)), random.normal(size=6)
    for row, kick in zip(found, kicks, strict=True):
        x = a * x + kick
        row[:] = x
    return found
