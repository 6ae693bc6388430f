"""What each candidate would change in the innovations, to first order, from each of its starts.

The observer keeps every model close to the measurement, so these columns depend little on which
other effects the model has. But a marker that is not where it should be, a clock that drifts or
loops on board change them all: then they are made anew beside what was found.
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

FAINT = 0.1  # standard deviations that a whole scale moves all readings together
SLOPE = 0.5  # of a difference: less of it stays if taken both ways, and it is curvature


@dataclass(frozen=True, eq=False)
class CandidateColumns:
    """Which columns are a candidate's.

    `secant` is the change from absence to its start, None where it starts from its absence;
    `derivatives`, one for each of its free parameters but thresholds.
    """

    candidate: Candidate
    secant: int | None
    derivatives: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """`base` innovations (6, n) of each run, and `columns` (c, 6, n), as this filter bank saw them.

    `blocks` say which columns belong to which candidate, `base_model` what the search starts from,
    `beside` the ids of the effects that the columns were made beside.
    """

    base_model: Model
    bank: FilterBank
    base: list[Array]
    columns: list[Array]
    blocks: tuple[CandidateColumns, ...]
    beside: tuple[str, ...] = ()

    @property
    def candidates(self) -> list[Candidate]:
        """All that have columns."""
        return [block.candidate for block in self.blocks]

    @property
    def count(self) -> int:
        """Number of columns."""
        return len(self.columns[0])

    @property
    def finite(self) -> bool:
        """Whether the observer holds the model that they were made at."""
        return all(np.isfinite(one).all() for one in self.base)


def linearise_candidates(
    bank: FilterBank, base: Hypothesis, candidates: Sequence[Candidate]
) -> Sensitivities:
    """Columns of all candidates around a hypothesis, but for those the observer cannot hold."""
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
    """Columns of the same candidates beside all that a hypothesis has.

    Those of an effect that it has are made beside the others. Zero where the observer cannot hold
    the model.
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
    """The candidate's columns, from this one on."""
    if candidate.absent:
        return CandidateColumns(candidate, None, tuple(range(first, first + len(candidate.sloped))))
    own = range(first + 1, first + 1 + len(candidate.sloped))
    return CandidateColumns(candidate, first, tuple(own))


def _columns(
    bank: FilterBank, base: Hypothesis, candidate: Candidate, absent: Sequence[Array]
) -> list[Array]:
    """The secant, if the start is not the effect's absence, and the derivatives (c, 6, n)."""
    seen = bank.linearise(Hypothesis(base.model, (candidate.term(candidate.sloped),)))
    columns = _silence_curvature(bank, seen)
    if not candidate.absent:
        each = zip(seen.e, absent, seen.J, strict=True)
        columns = [np.concatenate([(there - without)[None], J]) for there, without, J in each]
    return [own.astype(np.float32) for own in columns]  # six digits are enough for columns


def _silence_curvature(bank: FilterBank, seen: Linearised) -> list[Array]:
    """Derivatives (k, 6, n) of each run, zero where a difference shows no slope.

    In the plane a small tilt acts by its square. What that leaves of a difference is faint, but as
    random as the readings: scaled to one, it would explain all their noise.
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
    """Lengths (c,) of columns (c, 6, n), in standard deviations of the innovations that are read.

    What turns a vehicle about an axis that is held changes innovations there, and nobody sees it.
    """
    squares = [
        np.sum((run.innovation_mask.T * own / np.sqrt(filters.variance)[:, None]) ** 2, axis=(1, 2))
        for own, run, filters in zip(columns, bank.runs, bank.run_filters, strict=True)
    ]
    return np.asarray(np.sqrt(np.sum(squares, axis=0)))
