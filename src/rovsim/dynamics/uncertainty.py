"""Uncertainty of a fitted model: of its values, of which effects act, and unforeseeable noise."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, nearest
from rovsim.core.rounding import rounded
from rovsim.dynamics.effects.base import Effect
from rovsim.results.fitted import Correlation, FittedNoise


@dataclass(frozen=True, eq=False)
class Draws:
    """Effects with standard deviations of their values, and the correlation of these.

    Attributes:
        effects: all effects that were added to the vehicle's; values without a standard deviation
            are taken as exact.
        correlation: between values, which are named `effect.parameter`.
    """

    effects: tuple[Effect, ...]
    correlation: Correlation

    def refuse_strangers(self, where: object) -> None:
        """Refuse a correlation with a value that no effect has, or that has no standard deviation.

        Raises:
            BadInput: with this name, and the nearest possible one.
        """
        names = [f"{effect.id}.{name}" for effect in self.effects for name in effect.std]
        for name in self.correlation.between:
            if name not in names:
                raise BadInput(
                    f"correlation of '{name}'",
                    where=where,
                    expected="values of its effects that have a std",
                    remedy=nearest(name, names),
                )

    def draw(self, random: np.random.Generator) -> tuple[Effect, ...]:
        """Draw the effects' values from the Gaussian, each clipped to its range."""
        names = self.correlation.between
        sample = _square_root(self.correlation) @ random.normal(size=len(names))
        errors = dict(zip(names, sample, strict=True))
        return tuple(_add_errors(effect, errors, random) for effect in self.effects)


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Uncertainty of a model whose added effects were fitted.

    Attributes:
        noise: of disturbances and readings, fitted together with the effects.
        own: the model's own effects.
        instead: other sets of effects that explain the same, each with its probability; the rest
            is the probability of `own`.
    """

    noise: FittedNoise
    own: Draws
    instead: tuple[tuple[float, Draws], ...] = ()

    def draw(self, random: np.random.Generator) -> tuple[Effect, ...]:
        """Draw which effects act, then their values."""
        share = [p for p, _ in self.instead]
        chosen = random.choice(1 + len(share), p=np.array([1.0 - sum(share), *share]))
        return [self.own, *(draws for _, draws in self.instead)][chosen].draw(random)


def _add_errors(effect: Effect, errors: dict[str, float], random: np.random.Generator) -> Effect:
    """Add errors, in standard deviations, to an effect's values; draw errors not given."""
    z = {name: errors.get(f"{effect.id}.{name}", random.normal()) for name in effect.std}
    return effect.with_values(
        {
            p.name: float(np.clip(effect[p.name] + z[p.name] * effect.std[p.name], p.low, p.high))
            for p in effect.parameters
            if p.name in z
        }
    )


def _square_root(correlation: Correlation) -> Array:
    """A root A (k, k) of the correlation, A A' = C; eigenvalues below 0 by rounding are clipped."""
    values, vectors = np.linalg.eigh(correlation.lower)  # eigh reads only the lower triangle
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def correlate(covariance: Array, names: Sequence[str]) -> Correlation:
    """The correlation of a covariance (k, k) of values with these names, to nine digits."""
    std = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    rows = np.clip(covariance / np.outer(std, std), -1.0, 1.0)
    return Correlation(
        between=tuple(names),
        rows=tuple(tuple(rounded(r, 9) for r in row[: i + 1]) for i, row in enumerate(rows)),
    )
