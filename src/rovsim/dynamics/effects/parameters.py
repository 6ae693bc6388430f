"""What an effect declares of its numbers."""

from dataclasses import dataclass, field
from typing import Mapping

import numpy as np

from rovsim import AXES

# kg, the BlueROV2 Heavy (conf/vehicle): what is worth looking for in the catalogue is of its size.
REFERENCE_MASS = 13.5
STAMP = 0.001  # s: command logs are stamped in whole milliseconds


@dataclass(frozen=True)
class Parameter:
    """One number of an effect: its name, SI unit, symbol, allowed range and value when absent.

    A `default` of NaN means that the site decides where nothing is given. `scale` is the size of a
    change worth looking for: a fit works in multiples of it. `resolution`: changes much smaller
    than this do nothing, or all at once, or cannot be told from how a log rounds. Not `fitted`:
    only when asked for; but `shape`, once its effect is known to act, where the data determine it.
    `discrete`: it has a few values, one of which is right: they are tried. They are whole numbers,
    and none above `most` means anything; a search that adds two of them may pass it.
    `tried`: values of a threshold, with which commands or states are compared: what changes with it
    does so in jumps, and no derivative leads there.
    `reciprocal`: changes add in its reciprocal, as those of cutoffs do.
    """

    name: str
    unit: str
    symbol: str
    low: float = -np.inf
    high: float = np.inf
    default: float = 0.0
    scale: float = field(kw_only=True)
    resolution: float = field(default=0.0, kw_only=True)
    fitted: bool = field(default=True, kw_only=True)
    shape: bool = field(default=False, kw_only=True)
    discrete: bool = field(default=False, kw_only=True)
    most: float = field(default=np.inf, kw_only=True)
    tried: tuple[float, ...] = field(default=(), kw_only=True)
    reciprocal: bool = field(default=False, kw_only=True)

    @property
    def highest(self) -> float:
        """The largest value that means something."""
        return min(self.high, self.most)

    @property
    def neutral_value(self) -> float:
        """The value that changes nothing; zero where the site would decide."""
        return self.default if np.isfinite(self.default) else 0.0

    def combine(self, value: float, other: float, share: float = 1.0) -> float:
        """A value with a share of the change from neutral to another on top, inside the range."""
        if self.reciprocal:
            both = 1.0 / (1.0 / value + share * (1.0 / other - 1.0 / self.neutral_value))
        else:
            both = value + share * (other - self.neutral_value)
        return float(np.clip(both, self.low, self.high))

    def std_of(self, scaled: float) -> float:
        """Standard deviation in the parameter's unit, of a fitted one in scales.

        Within its resolution a value could be anywhere (uniform: / √12).
        """
        return float(np.hypot(scaled * self.scale, self.resolution / np.sqrt(12.0)))

    def size(self, value: float) -> float:
        """How large a change from neutral is, in the parameter's unit."""
        return abs(value) if self.reciprocal else abs(value - self.neutral_value)


def per_axis(
    translation: str,
    rotation: str,
    symbol: str,
    *,
    scales: tuple[float, float],
    low: float = -np.inf,
) -> tuple[Parameter, ...]:
    """Six parameters named surge ... yaw; units and scales of the two kinds of axes."""
    units = (translation, rotation)
    return tuple(
        Parameter(axis, units[i // 3], rf"{symbol}_{{{axis}}}", low, scale=scales[i // 3])
        for i, axis in enumerate(AXES)
    )


@dataclass(frozen=True)
class Signature:
    """How the catalogue page shows an effect: hidden with these values, in the error of one axis.

    The mean error, or its `size` (RMS), is drawn over a condition of
    `rovsim.evaluation.error_conditions`, or over a measured acceleration ("surge acceleration").
    """

    values: Mapping[str, float]
    axis: str
    condition: str
    size: bool = field(default=False, kw_only=True)
