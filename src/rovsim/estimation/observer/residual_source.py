"""Errors of models, how they change with parameters, and what makes them comparable."""

from dataclasses import dataclass
from typing import Callable, Protocol, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.noise import Noise

Errors = Callable[[Sequence[Model]], list[Array]]


@dataclass(frozen=True, eq=False)
class Linearised:
    """A hypothesis, its errors `e` (6, n) of each run, not whitened, and how they change.

    `J` (k, 6, n) of each run are their derivatives to the k scaled parameters.
    """

    hypothesis: Hypothesis
    e: list[Array]
    J: list[Array]

    @property
    def finite(self) -> bool:
        """Whether the model stayed finite on all runs, there and a step beside."""
        return all(np.isfinite(one).all() for one in (*self.e, *self.J))

    @property
    def rows(self) -> list[Array]:
        """Errors and derivatives (1 + k, 6, n) of each run."""
        return [np.concatenate([e[None], J]) for e, J in zip(self.e, self.J, strict=True)]


class ResidualSource(Protocol):
    """What a hypothesis is fitted to."""

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Errors (m, 6, n) of each run; NaN where a model cannot move at all."""

    def linearise(self, at: Hypothesis) -> Linearised:
        """Errors of a hypothesis, and how they change with its parameters."""

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Errors (..., 6, n) of all runs, each worth the same."""


def linearise(at: Hypothesis, errors: Errors, known: Linearised | None = None) -> Linearised:
    """Differences of the errors (m, 6, n) of each run that `errors` returns for m models.

    `known`: derivatives of another hypothesis, which stand for those to the same parameters. Those
    of a law are its own: its terms move up as others go.
    """
    count = len(at.x)
    taken = {} if known is None else _take(at, known)
    new = [i for i in range(count) if i not in taken]
    sizes = at.steps[new][:, None, None]
    every = errors([at.model, *(at.beside[i].model for i in new)])
    J = [np.empty((count, *e.shape[1:])) for e in every]
    for k, e in enumerate(every):
        J[k][new] = (e[1:] - e[0]) / sizes
        for i, of_runs in taken.items():
            J[k][i] = of_runs[k]
    return Linearised(at, [e[0] for e in every], J)


def _take(at: Hypothesis, known: Linearised) -> dict[int, list[Array]]:
    """Derivatives of each run to parameters of the catalogue that both have, by where they go."""
    listed = [term.effect.listed for term in known.hypothesis.terms for _ in term.free]
    rows = {name: k for k, name in enumerate(known.hypothesis.parameter_names) if listed[k]}
    each = enumerate(at.parameter_names)
    return {i: [J[rows[name]] for J in known.J] for i, name in each if name in rows}


def step_back(at: Hypothesis, i: int) -> Hypothesis | None:
    """The other way from `linearise`'s step of one parameter; None where its range ends there."""
    to = at.at(at.x - np.where(np.arange(len(at.x)) == i, at.steps, 0.0))
    return to if to.x[i] != at.x[i] else None


def evaluate_possible(
    models: Sequence[Model], count: int, errors: Callable[[Sequence[Model]], Array]
) -> Array:
    """Errors (m, 6, count) of models; NaN where a model cannot move at all."""
    able = [m.possible for m in models]
    e = np.full((len(models), 6, count), np.nan)
    if any(able):
        e[able] = errors([m for m, yes in zip(models, able, strict=True) if yes])
    return e
