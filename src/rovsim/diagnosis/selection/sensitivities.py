"""What each candidate would change in the innovations, to first order, from each of its starts.

The observer keeps every model close to the measurement, so these columns hardly depend on which
other effects the model has: they are made once.
"""

from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.least_squares import inner_products
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.selection.candidates import Candidate

ROUNDS = 3  # of fitting the noise and what it leaves in turns
SHRINK = 1e-4  # of each column's own square: parallel candidates share

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """`base` innovations (6, n) of each run, and `columns` (c, 6, n), as that bank saw them.

    Candidate i has the columns `secant[i]` (None where it starts from its absence), the change from
    absence to its start, and `derivatives[i]`, one for each of its free parameters.
    """

    bank: FilterBank
    candidates: tuple[Candidate, ...]
    base: list[Array]
    columns: list[Array]
    secant: tuple[int | None, ...]
    derivatives: tuple[tuple[int, ...], ...]

    @property
    def count(self) -> int:
        """Number of columns."""
        return len(self.columns[0])


def linearise_candidates(
    bank: FilterBank,
    base: Hypothesis,
    candidates: Sequence[Candidate],
    progress: Progress = lambda done, total: None,
) -> Sensitivities:
    """Columns of all candidates around a hypothesis."""
    e0 = [e[0] for e in bank.evaluate([base.model])]
    parts: list[list[Array]] = [[] for _ in e0]
    kept: list[Candidate] = []
    secant: list[int | None] = []
    derivatives: list[tuple[int, ...]] = []
    count = 0
    for done, candidate in enumerate(candidates):
        columns = _columns(bank, base, candidate, e0)
        progress(done + 1, len(candidates))
        if not all(np.isfinite(one).all() for one in columns):
            continue  # the observer cannot hold the model there
        kept.append(candidate)
        secant.append(None if candidate.absent else count)
        count += not candidate.absent
        derivatives.append(tuple(range(count, count + len(candidate.free))))
        count += len(candidate.free)
        for part, own in zip(parts, columns, strict=True):
            part.append(own)
    stacked = [np.concatenate(part) for part in parts]
    return Sensitivities(bank, tuple(kept), e0, stacked, tuple(secant), tuple(derivatives))


def _columns(
    bank: FilterBank, base: Hypothesis, candidate: Candidate, e0: Sequence[Array]
) -> list[Array]:
    """The secant, if the start is not the effect's absence, and the derivatives (c, 6, n)."""
    e, J = bank.linearise(Hypothesis(base.model, (candidate.term(),)))
    if not candidate.absent:
        J = [
            np.concatenate([(there - without)[None], own])
            for there, without, own in zip(e, e0, J, strict=True)
        ]
    return [own.astype(np.float32) for own in J]  # six digits are enough for columns


def fit_remaining_noise(found: Sensitivities, at: Hypothesis, noise: Noise) -> Noise:
    """The noise of what a hypothesis leaves and no candidate explains, all acting together.

    It is close to the true one whatever is still missing: candidates are compared under it.
    """
    close = found.bank
    e, J = close.linearise(at) if at.terms else (found.base, None)
    columns = found.columns if J is None else _both(J, found.columns)
    for _ in range(ROUNDS):
        noise, _ = close.fit_noise(_remainder(close, e, columns, noise), noise)
    return noise


def _both(J: Sequence[Array], columns: Sequence[Array]) -> list[Array]:
    pairs = zip(J, columns, strict=True)
    return [np.concatenate([own.astype(more.dtype), more]) for own, more in pairs]


def _remainder(close: FilterBank, e, columns, noise: Noise) -> list[Array]:
    """Innovations (6, n) of each run less the best combination of all columns (c, 6, n)."""
    target = close.coarsen([one[None] for one in e], noise)[0]
    white = close.coarsen(columns, noise)
    H = inner_products(white).astype(float)
    x = -np.linalg.solve(H + np.diag(SHRINK * np.diag(H) + 1e-9), white @ target)
    return [one + np.tensordot(x, c, axes=1) for one, c in zip(e, columns, strict=True)]
