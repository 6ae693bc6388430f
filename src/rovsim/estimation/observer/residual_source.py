"""The errors that a hypothesis is fitted to, and their derivatives to its parameters.

The errors are innovations in `filter_bank`, and errors of replays in `replay_fit`.
"""

from dataclasses import dataclass
from typing import Callable, Iterable, NamedTuple, Protocol, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.model import Model
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.noise import Noise

MIN_STEP_SHARE = 0.1  # of a step: where a range ends sooner, rounding would be all there is

Errors = Callable[[Sequence[Model]], list[Array]]


@dataclass(frozen=True, eq=False)
class Linearised:
    """A hypothesis with its errors, linearised in its k scaled parameters.

    Attributes:
        hypothesis: at which the errors were evaluated.
        e: errors (6, n) of each run, not whitened.
        J: their derivatives (k, 6, n) of each run.
    """

    hypothesis: Hypothesis
    e: list[Array]
    J: list[Array]

    @property
    def is_finite(self) -> bool:
        """Whether no error and no derivative diverged on any run."""
        return all(np.isfinite(x).all() for x in (*self.e, *self.J))

    @property
    def rows(self) -> list[Array]:
        """Errors and derivatives (1 + k, 6, n) of each run."""
        return [np.concatenate([e[None], J]) for e, J in zip(self.e, self.J, strict=True)]


class ResidualSource(Protocol):
    """Gives the errors that a hypothesis is fitted to."""

    def evaluate(self, models: Sequence[Model]) -> list[Array]:
        """Errors (m, 6, n) of m models on each run; NaN for models that are impossible."""

    def linearise(self, at: Hypothesis) -> Linearised:
        """Errors of a hypothesis, and their derivatives to its free parameters."""

    def whiten(self, e: Sequence[Array], noise: Noise) -> Array:
        """Errors (..., 6, n) of all runs, scaled so that each tells as much as any other."""


def linearise(at: Hypothesis, errors: Errors, previous: Linearised | None = None) -> Linearised:
    """Linearise the errors of a hypothesis by finite differences.

    Args:
        at: the hypothesis.
        errors: gives the errors (m, 6, n) of m models on each run.
        previous: another hypothesis, whose derivatives to the same parameters are used again. The
            parameters of a law are never the same: its terms are numbered anew as others go.
    """
    count = len(at.x)
    reused = {} if previous is None else _reuse_derivatives(at, previous)
    new = [i for i in range(count) if i not in reused]
    sizes = at.steps[new][:, None, None]
    outputs = errors([at.model, *(at.perturbed[i].model for i in new)])
    J = [np.empty((count, *e.shape[1:])) for e in outputs]
    for k, e in enumerate(outputs):
        J[k][new] = (e[1:] - e[0]) / sizes
        for i, of_runs in reused.items():
            J[k][i] = of_runs[k]
    return Linearised(at, [e[0] for e in outputs], J)


def linearise_centrally(at: Hypothesis, errors: Errors) -> Linearised:
    """Linearise by central differences, as far as the ranges of the parameters let it.

    It takes twice as long. Where forces and inertias grow by one factor, nothing changes at all; a
    difference to one side makes that look as if the runs determined the factor to 3 %.
    """
    forward = linearise(at, errors)
    back = slopes_behind(forward, range(len(at.x)), errors)
    J = [of_run.copy() for of_run in forward.J]
    for row, (i, behind) in enumerate(zip(back.numbers, back.sizes, strict=True)):
        ahead = at.steps[i]
        if abs(behind) > MIN_STEP_SHARE * abs(ahead):  # shorter where the range ends
            for of_run, slopes in zip(J, back.slopes, strict=True):
                of_run[i] = (behind * of_run[i] + ahead * slopes[row]) / (ahead + behind)
    return Linearised(at, forward.e, J)


class SlopesBehind(NamedTuple):
    """One-sided differences of errors, in the other direction than in `linearise`.

    Attributes:
        numbers: of the c parameters whose range lets them step back.
        sizes: of these steps (c,), with the sign of a step ahead.
        slopes: derivatives (c, 6, n) of each run; empty where no parameter can step back.
    """

    numbers: list[int]
    sizes: Array
    slopes: list[Array]


def slopes_behind(at: Linearised, numbers: Iterable[int], errors: Errors) -> SlopesBehind:
    """Differences from one step back, of those of these parameters that can take it."""
    back = {i: h for i in numbers if (h := step_back(at.hypothesis, i)) is not None}
    sizes = np.array([at.hypothesis.x[i] - h.x[i] for i, h in back.items()])
    outputs = errors([h.model for h in back.values()]) if back else []
    slopes = [(e - b) / sizes[:, None, None] for e, b in zip(at.e, outputs, strict=bool(back))]
    return SlopesBehind(list(back), sizes, slopes)


def _reuse_derivatives(at: Hypothesis, previous: Linearised) -> dict[int, list[Array]]:
    """Derivatives of `previous` to parameters that both have, by their place in `at`.

    Each is one array (6, n) per run; parameters of a law, which no catalogue lists, are left out.
    """
    listed = [term.effect.listed for term in previous.hypothesis.terms for _ in term.free]
    rows = {name: k for k, name in enumerate(previous.hypothesis.parameter_names) if listed[k]}
    names = enumerate(at.parameter_names)
    return {i: [J[rows[name]] for J in previous.J] for i, name in names if name in rows}


def step_back(at: Hypothesis, i: int) -> Hypothesis | None:
    """The hypothesis one step of its i-th parameter in the other direction than in `linearise`.

    None where the parameter's range ends there.
    """
    to = at.at(at.x - np.where(np.arange(len(at.x)) == i, at.steps, 0.0))
    return to if to.x[i] != at.x[i] else None


def evaluate_possible(
    models: Sequence[Model], count: int, errors: Callable[[Sequence[Model]], Array]
) -> Array:
    """Errors (m, 6, count) of m models on one run; NaN for models that are impossible.

    Args:
        models: all of them. Impossible is one whose inertia is not positive definite, for example.
        count: of the errors on each axis.
        errors: gives those of the possible models.
    """
    possible = [m.possible for m in models]
    e = np.full((len(models), 6, count), np.nan)
    if any(possible):
        e[possible] = errors([m for m, flag in zip(models, possible, strict=True) if flag])
    return e
