"""What a learned residual looks at: velocity, thrust, the model's acceleration, gravity."""

from typing import Literal

import numpy as np
from numba import njit
from numpy import ndarray as Array
from pydantic import field_validator

from rovsim.core.rotations import unrotate
from rovsim.core.schema import Section
from rovsim.dynamics.engine.compiled import FROM_PYTHON, UNSEEN
from rovsim.dynamics.learned.layout import BLOCKS

Block = Literal["velocity", "wrench", "acceleration", "gravity"]

# Columns of each block, in the order in which blocks stand in a feature vector.
COLUMNS: dict[str, tuple[str, ...]] = {
    "velocity": ("u", "v", "w", "p", "q", "r"),
    "wrench": ("X", "Y", "Z", "K", "M", "N"),
    "acceleration": ("u_dot", "v_dot", "w_dot", "p_dot", "q_dot", "r_dot"),
    "gravity": ("down_x", "down_y", "down_z"),
}
FEATURES = sum(len(columns) for columns in COLUMNS.values())  # the longest feature vector

VELOCITY, WRENCH, ACCELERATION, GRAVITY = 1, 2, 4, 8
CODES = dict(zip(COLUMNS, (VELOCITY, WRENCH, ACCELERATION, GRAVITY), strict=True))


class FeatureSettings(Section):
    """Which blocks a residual sees, and how they are brought to one size.

    velocity + wrench are the 12 features of the thesis' small set; with acceleration they are the
    18 of its large set. Blocks always stand in the order of `COLUMNS`.
    """

    blocks: tuple[Block, ...] = ("velocity", "wrench")
    # metres per second and newtons differ by two orders: unscaled, thrust alone sets the distance
    scaling: Literal["standard", "range", "none"] = "standard"

    @field_validator("blocks")
    @classmethod
    def _ordered(cls, blocks: tuple[Block, ...]) -> tuple[Block, ...]:
        if not blocks or len(set(blocks)) != len(blocks):
            raise ValueError(f"at least one of {', '.join(COLUMNS)}, each once")
        return tuple(sorted(blocks, key=list(COLUMNS).index))


def feature_names(settings: FeatureSettings) -> list[str]:
    """Names of the columns of a feature matrix, in order."""
    return [name for block in settings.blocks for name in COLUMNS[block]]


def blocks_code(settings: FeatureSettings) -> int:
    """The blocks as one number, for `assemble_one`."""
    return sum(CODES[block] for block in settings.blocks)


def assemble(
    settings: FeatureSettings, nu: Array, nu_dot: Array, wrench: Array, attitude: Array
) -> Array:
    """Feature matrix X (n, d) of n samples.

    Args:
        settings: which blocks.
        nu: body velocity (n, 6), m/s and rad/s.
        nu_dot: acceleration (n, 6) of the base model at that state, m/s2 and rad/s2.
        wrench: thruster wrench (n, 6), N and N m.
        attitude: unit quaternions (n, 4), body to world.
    """
    down = unrotate(attitude, np.array([0.0, 0.0, 1.0]))
    blocks = {"velocity": nu, "wrench": wrench, "acceleration": nu_dot, "gravity": down}
    return np.concatenate([blocks[block] for block in settings.blocks], axis=1)


@njit(**UNSEEN)
def _append(values, x, at):
    """Write values into x from `at` on; returns where the next block starts."""
    for i in range(len(values)):
        x[at + i] = values[i]
    return at + len(values)


@njit(**FROM_PYTHON)
def assemble_one(data, nu, nu_dot, wrench, R, x):
    """Write the features of one sample into x (at least d long), as `assemble` would.

    `data` is an exported residual (only its blocks' code is read); R rotates body to world.
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
