"""What pushes the true vehicle and nobody logs."""

import numpy as np
from numpy import ndarray as Array

from rovsim.simulation.synthetic_tank.settings import Turbulence


def draw_turbulence(
    settings: Turbulence, steps: int, h: float, random: np.random.Generator
) -> Array:
    """Gauss-Markov wrench (steps, 6) in body axes over steps of h s, stationary from the start."""
    level = np.repeat([settings.force, settings.moment], 3)
    a = np.exp(-h / settings.time_constant)
    kicks = random.normal(size=(steps, 6)) * np.sqrt(1.0 - a * a)
    wrench, x = np.empty((steps, 6)), random.normal(size=6)
    for row, kick in zip(wrench, kicks, strict=True):
        x = a * x + kick
        row[:] = x
    return wrench * level
