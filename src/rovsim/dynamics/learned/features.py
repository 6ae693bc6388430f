"""Features of a learned residual: velocity, thrust, the model's acceleration, gravity."""

import numpy as np
from numba import njit
from numpy import ndarray as Array

from rovsim.core.rotations import unrotate
from rovsim.dynamics.compilation.compiled import FROM_PYTHON, INTERNAL
from rovsim.dynamics.learned.layout import BLOCKS
from rovsim.dynamics.learned.settings import (
    ACCELERATION,
    GRAVITY,
    VELOCITY,
    WRENCH,
    FeatureSettings,
)


def assemble(
    settings: FeatureSettings, nu: Array, nu_dot: Array, wrench: Array, attitude: Array
) -> Array:
    """Assemble the feature matrix X (n, d) of n samples.

    Args:
        settings: which blocks of features there are.
        nu: body velocity (n, 6), m/s and rad/s.
        nu_dot: body acceleration (n, 6) of the base model at that state, m/s2 and rad/s2.
        wrench: thruster wrench (n, 6), N and N m, in body axes FRD at CO.
        attitude: unit quaternions (n, 4), body to world.
    """
    down = unrotate(attitude, np.array([0.0, 0.0, 1.0]))
    blocks = {"velocity": nu, "wrench": wrench, "acceleration": nu_dot, "gravity": down}
    return np.concatenate([blocks[block] for block in settings.blocks], axis=1)


@njit(**INTERNAL)
def _append(values, x, at):
    """Write values into x from index `at` on; returns the index after the last one."""
    for i in range(len(values)):
        x[at + i] = values[i]
    return at + len(values)


@njit(**FROM_PYTHON)
def assemble_one(data, nu, nu_dot, wrench, R, x):
    """Write the features of one sample into x, in the order of `assemble`.

    Args:
        data: an exported residual, of which only the code of the feature blocks is read.
        nu: (6,) body velocity, m/s and rad/s.
        nu_dot: (6,) body acceleration of the base model, m/s2 and rad/s2.
        wrench: (6,) thruster wrench, N and N m.
        R: rotation matrix from body to world, three rows.
        x: is written to; at least d long.
    """
    code, at = int(data[BLOCKS]), 0
    if code & VELOCITY:
        at = _append(nu, x, at)
    if code & WRENCH:
        at = _append(wrench, x, at)
    if code & ACCELERATION:
        at = _append(nu_dot, x, at)
    if code & GRAVITY:
        _append(R[2], x, at)  # the world's down axis, in body axes
