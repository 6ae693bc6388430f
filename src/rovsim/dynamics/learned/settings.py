"""Settings of a trained residual: the runs it learned from, and its features."""

from typing import Literal

from pydantic import field_validator

from rovsim.core.axes import FORCE as FORCE_LETTERS
from rovsim.core.axes import VELOCITY as VELOCITY_LETTERS
from rovsim.core.schema import Section

Control = Literal["3dof", "6dof", "all"]  # runs a residual learns from
Block = Literal["velocity", "wrench", "acceleration", "gravity"]

# Columns of each block, in the order in which blocks stand in a feature vector.
COLUMNS: dict[str, tuple[str, ...]] = {
    "velocity": VELOCITY_LETTERS,
    "wrench": FORCE_LETTERS,
    "acceleration": tuple(f"{letter}_dot" for letter in VELOCITY_LETTERS),
    "gravity": ("down_x", "down_y", "down_z"),
}
MAX_FEATURES = sum(len(columns) for columns in COLUMNS.values())  # the longest feature vector

VELOCITY, WRENCH, ACCELERATION, GRAVITY = 1, 2, 4, 8
BLOCK_CODES = dict(zip(COLUMNS, (VELOCITY, WRENCH, ACCELERATION, GRAVITY), strict=True))


class FeatureSettings(Section):
    """Which blocks of features a residual sees, and how they are scaled.

    The blocks velocity and wrench are the 12 features of the thesis' small set; with acceleration
    they are the 18 of its large set. Blocks always stand in the order of `COLUMNS`.
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
    """The blocks as one number, a bit for each block, for `assemble_one`."""
    return sum(BLOCK_CODES[block] for block in settings.blocks)
