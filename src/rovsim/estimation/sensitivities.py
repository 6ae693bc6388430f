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
from rovsim.estimation.observer.residual_source import Linearised, slopes_behind

MAX_ROUNDING_STDS = 1e-6  # standard deviations: a fainter difference is that of rounded numbers
MIN_VISIBLE_STDS = 0.1  # standard deviations by which a whole scale moves all readings together
MIN_CENTRAL_SHARE = 0.5  # of a one-sided difference: with less it is curvature


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
        added_ids: ids of the effects that this model has besides those of `base_model`.
    """

    base_model: Model
    bank: FilterBank
    base: list[Array]
    columns: list[Array]
    blocks: tuple[CandidateColumns, ...]
    added_ids: tuple[str, ...] = ()

    @property
    def candidates(self) -> list[Candidate]:
        """All candidates that have columns."""
        return [block.candidate for block in self.blocks]

    @property
    def count(self) -> int:
        """Number of columns."""
        return len(self.columns[0])

    @property
    def is_finite(self) -> bool:
        """Whether the model that the columns were made at did not diverge."""
        return all(np.isfinite(x).all() for x in self.base)


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
        if all(np.isfinite(x).all() for x in columns):
            blocks.append(_number_columns(candidate, count))
            parts.append(columns)
            count += len(columns[0])
    matrices = [np.concatenate(of_run) for of_run in zip(*parts, strict=True)]
    return Sensitivities(base.model, bank, absent, matrices, tuple(blocks))


def relinearise_candidates(
    bank: FilterBank, at: Hypothesis, previous: Sensitivities
) -> Sensitivities:
    """Make the columns of the same candidates anew, with all effects of a hypothesis in place.

    Those of an effect that the hypothesis has itself are made beside its other effects. Columns are
    zero where the model diverges.
    """
    bases: dict[str, tuple[Hypothesis, list[Array]]] = {}
    parts = []
    for candidate in previous.candidates:
        others = at.without_effect(candidate.effect.id)
        effect_id = candidate.effect.id if len(others.terms) < len(at.terms) else ""
        if effect_id not in bases:
            model = others.model
            bases[effect_id] = Hypothesis(model), bank.innovations(model)
        columns = _columns(bank, bases[effect_id][0], candidate, bases[effect_id][1])
        finite = all(np.isfinite(x).all() for x in columns)
        parts.append(columns if finite else [np.zeros_like(x) for x in columns])
    matrices = [np.concatenate(of_run) for of_run in zip(*parts, strict=True)]
    base, added_ids = bank.innovations(at.model), tuple(term.id for term in at.terms)
    return replace(previous, bank=bank, base=base, columns=matrices, added_ids=added_ids)


def _number_columns(candidate: Candidate, first: int) -> CandidateColumns:
    """Number the candidate's columns, beginning at `first`."""
    if candidate.absent:
        return CandidateColumns(candidate, None, tuple(range(first, first + len(candidate.sloped))))
    columns = range(first + 1, first + 1 + len(candidate.sloped))
    return CandidateColumns(candidate, first, tuple(columns))


def _columns(
    bank: FilterBank, base: Hypothesis, candidate: Candidate, absent: Sequence[Array]
) -> list[Array]:
    """The candidate's columns (c, 6, n) of each run: its secant, if any, then derivatives."""
    linearised = bank.linearise(Hypothesis(base.model, (candidate.term(candidate.sloped),)))
    columns = _silence_curvature(bank, linearised)
    if not candidate.absent:
        inputs = zip(linearised.e, absent, linearised.J, strict=True)
        columns = [np.concatenate([(e - e_absent)[None], J]) for e, e_absent, J in inputs]
    return [c.astype(np.float32) for c in columns]  # six digits are enough


def _silence_curvature(bank: FilterBank, linearised: Linearised) -> list[Array]:
    """Derivatives (k, 6, n) of each run, zero where the difference is only curvature or rounding.

    A small tilt of a vehicle that moves in a plane acts by its square. Its one-sided difference is
    faint, but as random as the readings: scaled to unit size, it would explain all their noise.
    """
    if not linearised.is_finite:
        return linearised.J
    lengths = measure_columns(bank, linearised.J)
    meant = lengths > MAX_ROUNDING_STDS
    faint_ones = np.flatnonzero(meant & (lengths < MIN_VISIBLE_STDS)).tolist()
    faint, _, slopes = slopes_behind(linearised, faint_ones, bank.evaluate)
    scale = np.where(meant, 1.0, 0.0)[:, None, None]
    if not faint:
        return [scale * J for J in linearised.J]
    central = [0.5 * (J[faint] + back) for J, back in zip(linearised.J, slopes, strict=True)]
    scale[faint, 0, 0] = measure_columns(bank, central) >= MIN_CENTRAL_SHARE * lengths[faint]
    return [scale * J for J in linearised.J]


def measure_columns(bank: FilterBank, columns: Sequence[Array]) -> Array:
    """Lengths (c,) of columns (c, 6, n), in standard deviations of the innovations.

    Only axes that were read count: along others, nobody sees that innovations change.
    """
    squares = [
        np.sum((run.innovation_mask.T * x / np.sqrt(filters.variance)[:, None]) ** 2, axis=(1, 2))
        for x, run, filters in zip(columns, bank.runs, bank.run_filters, strict=True)
    ]
    return np.asarray(np.sqrt(np.sum(squares, axis=0)))
