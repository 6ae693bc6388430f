"""Sensitivities: how each candidate would change the innovations, to first order.

Each candidate has columns: derivatives of the innovations to its parameters, from each of its
starts. The filters keep every model close to the measurement, so the columns depend little on which
other effects the model has. But a misplaced marker, a clock that drifts or a loop on board changes
all columns. They are then made anew with the accepted effects in place.
"""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.model import Model
from rovsim.estimation.candidates import Candidate
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.residual_source import Linearised, step_back

FAINT = 0.1  # standard deviations by which a whole scale moves all readings together
SLOPE = 0.5  # of a one-sided difference: if the central one keeps less, it is curvature


@dataclass(frozen=True, eq=False)
class CandidateColumns:
    """Which columns belong to a candidate.

    Attributes:
        candidate: the effect, at one of its starts.
        secant: column with the whole change from the effect's absence to its start; None where it
            starts from its absence.
        derivatives: columns with the derivatives to its free parameters, thresholds left out.
    """

    candidate: Candidate
    secant: int | None
    derivatives: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """The columns of all candidates, and the innovations that they would change.

    Attributes:
        base_model: the model that the search starts from.
        bank: the filters that innovations and columns come from.
        base: innovations (6, n) of each run, of the model that the columns were made at.
        columns: (c, 6, n) of each run.
        blocks: which columns belong to which candidate.
        beside: ids of the effects that this model has besides those of `base_model`.
    """

    base_model: Model
    bank: FilterBank
    base: list[Array]
    columns: list[Array]
    blocks: tuple[CandidateColumns, ...]
    beside: tuple[str, ...] = ()

    @property
    def candidates(self) -> list[Candidate]:
        """All candidates that have columns."""
        return [block.candidate for block in self.blocks]

    @property
    def count(self) -> int:
        """Number of columns."""
        return len(self.columns[0])

    @property
    def finite(self) -> bool:
        """Whether the model that the columns were made at did not diverge."""
        return all(np.isfinite(one).all() for one in self.base)


def linearise_candidates(
    bank: FilterBank, base: Hypothesis, candidates: Sequence[Candidate]
) -> Sensitivities:
    """Make the columns of all candidates at a hypothesis; without those that make it diverge."""
    absent = bank.innovations(base.model)
    blocks: list[CandidateColumns] = []
    parts: list[list[Array]] = []
    count = 0
    for candidate in candidates:
        columns = _columns(bank, base, candidate, absent)
        if all(np.isfinite(one).all() for one in columns):
            blocks.append(_place(candidate, count))
            parts.append(columns)
            count += len(columns[0])
    stacked = [np.concatenate(of_run) for of_run in zip(*parts, strict=True)]
    return Sensitivities(base.model, bank, absent, stacked, tuple(blocks))


def linearise_beside(bank: FilterBank, at: Hypothesis, known: Sensitivities) -> Sensitivities:
    """Make the columns of the same candidates anew, with all effects of a hypothesis in place.

    Those of an effect that the hypothesis has itself are made beside its other effects. Columns are
    zero where the model diverges.
    """
    rests: dict[str, tuple[Hypothesis, list[Array]]] = {}
    parts = []
    for candidate in known.candidates:
        others = tuple(term for term in at.terms if term.id != candidate.effect.id)
        own = candidate.effect.id if len(others) < len(at.terms) else ""
        if own not in rests:
            model = replace(at, terms=others).model
            rests[own] = Hypothesis(model), bank.innovations(model)
        columns = _columns(bank, rests[own][0], candidate, rests[own][1])
        finite = all(np.isfinite(one).all() for one in columns)
        parts.append(columns if finite else [np.zeros_like(one) for one in columns])
    stacked = [np.concatenate(of_run) for of_run in zip(*parts, strict=True)]
    base, beside = bank.innovations(at.model), tuple(term.id for term in at.terms)
    return replace(known, bank=bank, base=base, columns=stacked, beside=beside)


def _place(candidate: Candidate, first: int) -> CandidateColumns:
    """Number the candidate's columns, beginning at `first`."""
    if candidate.absent:
        return CandidateColumns(candidate, None, tuple(range(first, first + len(candidate.sloped))))
    own = range(first + 1, first + 1 + len(candidate.sloped))
    return CandidateColumns(candidate, first, tuple(own))


def _columns(
    bank: FilterBank, base: Hypothesis, candidate: Candidate, absent: Sequence[Array]
) -> list[Array]:
    """The candidate's columns (c, 6, n) of each run: its secant, if any, then derivatives."""
    seen = bank.linearise(Hypothesis(base.model, (candidate.term(candidate.sloped),)))
    columns = _silence_curvature(bank, seen)
    if not candidate.absent:
        each = zip(seen.e, absent, seen.J, strict=True)
        columns = [np.concatenate([(there - without)[None], J]) for there, without, J in each]
    return [own.astype(np.float32) for own in columns]  # six digits are enough


def _silence_curvature(bank: FilterBank, seen: Linearised) -> list[Array]:
    """Derivatives (k, 6, n) of each run, set to zero where the difference is only curvature.

    A small tilt of a vehicle that moves in a plane acts by its square. Its one-sided difference is
    faint, but as random as the readings: scaled to unit size, it would explain all their noise.
    """
    lengths = measure_columns(bank, seen.J)
    back = {i: step_back(seen.hypothesis, i) for i in np.flatnonzero(lengths < FAINT).tolist()}
    able = {i: one for i, one in back.items() if one is not None}
    if not able or not seen.finite:
        return seen.J
    faint = list(able)
    sizes = np.array([(seen.hypothesis.x - one.x)[i] for i, one in able.items()])[:, None, None]
    moved = bank.evaluate([one.model for one in able.values()])
    both = [
        0.5 * (J[faint] + (e - beside) / sizes)
        for J, e, beside in zip(seen.J, seen.e, moved, strict=True)
    ]
    shown = np.ones((len(lengths), 1, 1))
    shown[faint, 0, 0] = measure_columns(bank, both) >= SLOPE * lengths[faint]
    return [shown * J for J in seen.J]


def measure_columns(bank: FilterBank, columns: Sequence[Array]) -> Array:
    """Lengths (c,) of columns (c, 6, n), in standard deviations of the innovations.

    Only axes that were read count: along others, nobody sees that innovations change.
    """
    squares = [
        np.sum((run.innovation_mask.T * own / np.sqrt(filters.variance)[:, None]) ** 2, axis=(1, 2))
        for own, run, filters in zip(columns, bank.runs, bank.run_filters, strict=True)
    ]
    return np.asarray(np.sqrt(np.sum(squares, axis=0)))
