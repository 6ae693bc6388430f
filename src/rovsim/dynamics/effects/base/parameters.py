"""Declarations of an effect: its parameters, and how the catalogue page shows it."""

from dataclasses import dataclass, field
from typing import Mapping

import numpy as np

from rovsim.core.axes import AXES

# kg, the BlueROV2 Heavy (conf/vehicle): `Parameter.scale` in the catalogue suits its size.
REFERENCE_MASS = 13.5
STAMP_STEP = 0.001  # s: command logs are stamped in whole milliseconds


@dataclass(frozen=True)
class Parameter:
    """One parameter of an effect.

    Attributes:
        name: by which files and code refer to it.
        unit: SI.
        symbol: in LaTeX, as in the equation of the effect.
        low: least value.
        high: largest value.
        default: value if none is given; NaN means that it then follows from the site.
        scale: size of a change worth looking for; fits work in multiples of it.
        resolution: a smaller change has no effect, or a sudden one, or cannot be distinguished
            from the rounding of a log.
        fitted: whether fits estimate it; otherwise they do so only on request, or see `shape`.
        shape: not `fitted` at first, but once the effect is accepted, if the data determine it.
        discrete: whether only a few whole numbers are possible, which are tried one by one.
        most: largest meaningful value of a discrete parameter. A search that adds the values of
            two effects may exceed it.
        tried: values to try for a threshold that commands or states are compared with. The
            response to a threshold changes in jumps, so that no derivative can guide a fit.
        reciprocal: whether changes add in 1 / value, as those of cutoff frequencies do.
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
        """The largest meaningful value: the lower of `high` and `most`."""
        return min(self.high, self.most)

    @property
    def range_in_words(self) -> str:
        """What values are possible, after "a number": "from 0 to 1", "of at least 0 s"."""
        low, high = (f"{limit:g} {self.unit}".removesuffix(" 1") for limit in (self.low, self.high))
        if np.isfinite(self.low) and np.isfinite(self.high):
            return f"from {self.low:g} to {high}"
        if np.isfinite(self.low):
            return f"of at least {low}"
        return f"of at most {high}" if np.isfinite(self.high) else "that is finite"

    @property
    def neutral_value(self) -> float:
        """The value at which the effect changes nothing: the default, or zero if that is NaN."""
        return self.default if np.isfinite(self.default) else 0.0

    def combine(self, value: float, other: float, share: float = 1.0) -> float:
        """Add a share of the change from neutral to `other` to a value; clip to the range."""
        if self.reciprocal:
            combined = 1.0 / (1.0 / value + share * (1.0 / other - 1.0 / self.neutral_value))
        else:
            combined = value + share * (other - self.neutral_value)
        return float(np.clip(combined, self.low, self.high))

    def std_of(self, scaled: float) -> float:
        """Standard deviation in the parameter's unit, of one in multiples of `scale`.

        Adds the uniform distribution of a value within its resolution (resolution / √12).
        """
        return float(np.hypot(scaled * self.scale, self.resolution / np.sqrt(12.0)))

    def size(self, value: float) -> float:
        """Absolute change from neutral; of a reciprocal parameter the absolute value."""
        return abs(value) if self.reciprocal else abs(value - self.neutral_value)


def per_axis(
    translation: str,
    rotation: str,
    symbol: str,
    *,
    scales: tuple[float, float],
    low: float = -np.inf,
) -> tuple[Parameter, ...]:
    """Six parameters named surge ... yaw; scales are of translations, then of rotations."""
    units = (translation, rotation)
    return tuple(
        Parameter(axis, units[i // 3], rf"{symbol}_{{{axis}}}", low, scale=scales[i // 3])
        for i, axis in enumerate(AXES)
    )


@dataclass(frozen=True)
class Signature:
    """How the catalogue page shows an effect: by the error of a model that lacks it.

    Attributes:
        values: parameters of the effect that acts.
        axis: whose error is shown.
        condition: a condition of `rovsim.evaluation.error_conditions`, or a measured acceleration
            ("surge acceleration"), over which the error is drawn.
        size: whether the RMS error is drawn, instead of the mean error.
    """

    values: Mapping[str, float]
    axis: str
    condition: str
    size: bool = field(default=False, kw_only=True)
