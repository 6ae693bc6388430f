"""What a model leaves open: its values, the names of its effects, and what no model foresees."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput, nearest
from rovsim.dynamics.effects.base import Effect
from rovsim.results.fitted import Correlation, FittedNoise


@dataclass(frozen=True, eq=False)
class Draws:
    """Effects whose values are known to their standard deviations, and how these hang together.

    `effects` are all that were added to the vehicle's; what has no deviation stays as it is.
    """

    effects: tuple[Effect, ...]
    correlation: Correlation

    def refuse_strangers(self, where: object) -> None:
        """Refuse a correlation with a value that no effect has, or that is known exactly.

        Raises:
            BadInput: names it, and the nearest that would do.
        """
        known = [f"{effect.id}.{name}" for effect in self.effects for name in effect.std]
        for name in self.correlation.between:
            if name not in known:
                raise BadInput(
                    f"correlation of '{name}'",
                    where=where,
                    expected="values of its effects that have a std",
                    remedy=nearest(name, known),
                )

    def draw(self, random: np.random.Generator) -> tuple[Effect, ...]:
        """The effects at values drawn from a Gaussian, each kept inside its range."""
        between = self.correlation.between
        drawn = _root(self.correlation) @ random.normal(size=len(between))
        errors = dict(zip(between, drawn, strict=True))
        return tuple(_move(effect, errors, random) for effect in self.effects)


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Of a model whose added effects were fitted.

    `noise` that was fitted with them; `own` its effects, `instead` other effects that explain the
    same, each with its probability.
    """

    noise: FittedNoise
    own: Draws
    instead: tuple[tuple[float, Draws], ...] = ()

    def draw(self, random: np.random.Generator) -> tuple[Effect, ...]:
        """Added effects as they may as well be."""
        share = [p for p, _ in self.instead]
        chosen = random.choice(1 + len(share), p=np.array([1.0 - sum(share), *share]))
        return [self.own, *(draws for _, draws in self.instead)][chosen].draw(random)


def _move(effect: Effect, errors: dict[str, float], random: np.random.Generator) -> Effect:
    """One effect off by so many deviations; what is correlated with nothing errs by itself."""
    off = {name: errors.get(f"{effect.id}.{name}", random.normal()) for name in effect.std}
    return effect.with_values(
        {
            p.name: float(np.clip(effect[p.name] + off[p.name] * effect.std[p.name], p.low, p.high))
            for p in effect.parameters
            if p.name in off
        }
    )


def _root(correlation: Correlation) -> Array:
    """A matrix (k, k) whose square is the correlation; of what rounding left of it."""
    values, vectors = np.linalg.eigh(correlation.lower)  # reads no more than that triangle
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def correlate(covariance: Array, names: Sequence[str]) -> Correlation:
    """Of a covariance (k, k) of values called so, to nine digits."""
    std = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    rows = np.clip(covariance / np.outer(std, std), -1.0, 1.0)
    return Correlation(
        between=tuple(names),
        rows=tuple(tuple(float(f"{r:.9g}") for r in row[: i + 1]) for i, row in enumerate(rows)),
    )
