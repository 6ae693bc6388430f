"""The errors that a hypothesis is fitted to, and their derivatives to its parameters.

The errors are innovations in `filter_bank`, and errors of replays in `replay_fit`.
"""

from dataclasses import dataclass
from typing import Callable, Protocol, Sequence

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
    back = {i: h for i in range(len(at.x)) if (h := step_back(at, i)) is not None}
    near = MIN_STEP_SHARE * np.abs(at.steps)
    backward = {i: h for i, h in back.items() if abs(at.x[i] - h.x[i]) > near[i]}
    J = [of_run.copy() for of_run in forward.J]
    if backward:
        outputs = errors([h.model for h in backward.values()])
        for k, e_back in enumerate(outputs):
            for (i, h), e in zip(backward.items(), e_back, strict=True):
                ahead, behind = at.steps[i], at.x[i] - h.x[i]  # shorter where the range ends
                slope_behind = (forward.e[k] - e) / behind
                J[k][i] = (behind * J[k][i] + ahead * slope_behind) / (ahead + behind)
    return Linearised(at, forward.e, J)


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
