"""What each candidate would change in the innovations, to first order, from each of its starts.

The observer keeps every model close to the measurement, so these columns depend little on which
other effects the model has. But a marker that is not where it should be, a clock that drifts or
loops on board change them all: then they are made anew beside what was found.
"""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.least_squares import inner_products
from rovsim.diagnosis.observer.noise import FIRST_NOISE, Noise
from rovsim.diagnosis.observer.noise_fit import NoiseFit
from rovsim.diagnosis.selection.candidates import Candidate
from rovsim.dynamics.model import Model

DRAW = 0  # seed
ENOUGH = 10_000  # readings: the noise of fewer hangs on what was drawn; so more is drawn
ROUNDS = 10  # at most, where the noise is not yet known
CLOSE = 0.1  # of a level of noise: changed by less, it is known
SETTLED = 1.0  # in twice the log likelihood: gained by less, so is a hypothesis' own noise
SHRINK = 1e-4  # of each column's own square: parallel candidates share


@dataclass(frozen=True, eq=False)
class CandidateColumns:
    """Which columns are a candidate's.

    `secant` is the change from absence to its start, None where it starts from its absence;
    `derivatives`, one for each of its free parameters.
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
        held = all(np.isfinite(one).all() for one in columns)
        parts.append(columns if held else [np.zeros_like(one) for one in columns])
    stacked = [np.concatenate(of_run) for of_run in zip(*parts, strict=True)]
    base, beside = bank.innovations(at.model), tuple(term.id for term in at.terms)
    return replace(known, bank=bank, base=base, columns=stacked, beside=beside)


def _place(candidate: Candidate, first: int) -> CandidateColumns:
    """The candidate's columns, from this one on."""
    if candidate.absent:
        return CandidateColumns(candidate, None, tuple(range(first, first + len(candidate.free))))
    own = range(first + 1, first + 1 + len(candidate.free))
    return CandidateColumns(candidate, first, tuple(own))


def _columns(
    bank: FilterBank, base: Hypothesis, candidate: Candidate, absent: Sequence[Array]
) -> list[Array]:
    """The secant, if the start is not the effect's absence, and the derivatives (c, 6, n)."""
    seen = bank.linearise(Hypothesis(base.model, (candidate.term(),)))
    columns = seen.J
    if not candidate.absent:
        each = zip(seen.e, absent, seen.J, strict=True)
        columns = [np.concatenate([(there - without)[None], J]) for there, without, J in each]
    return [own.astype(np.float32) for own in columns]  # six digits are enough for columns


def fit_remaining_noise(
    sensitivities: Sensitivities, at: Hypothesis, noise: Noise, rounds: int = ROUNDS
) -> Noise:
    """The noise of what a hypothesis leaves and no candidate explains, all acting together.

    It is close to the true one whatever is still missing: candidates are compared under it. What is
    left depends on the noise in turn, so that this takes up to `rounds`; the last looks for slow
    errors of the readings and for a current that wanders.

    Where axes hang together, a wrong noise of one can pass for an effect on another, and the two
    then hold each other. So it is the noise of the hypothesis alone where that is likelier by more
    than one for each column, which is what chance gives them.
    """
    bank, e, columns = sensitivities.bank, sensitivities.base, sensitivities.columns
    if at.terms:
        seen = bank.linearise(at)
        e, columns = seen.e, _join(seen.J, columns)
    for _ in range(rounds - 1):
        known = noise
        noise = bank.fit_axes(_remainder(bank, e, columns, known), known).noise
        if np.max(np.abs(np.log(noise.level / known.level))) < CLOSE:
            break
    found = bank.fit_noise(_remainder(bank, e, columns, noise), noise, thorough=True)
    own = _fit_own_noise(bank, at.model, found.noise)
    return (own if own.likelihood > found.likelihood + sensitivities.count else found).noise


def _fit_own_noise(bank: FilterBank, model: Model, noise: Noise) -> NoiseFit:
    """The likeliest noise if nothing is missing from a model, with filters that suit it.

    Each round starts from the first guess: a level that once fell to zero does not come back.
    """
    first = replace(
        FIRST_NOISE, colour=noise.colour, colour_memory=noise.colour_memory, drift=noise.drift
    )
    found = NoiseFit(noise, -np.inf)
    for _ in range(ROUNDS):
        bank = bank.redesign(model, found.noise)
        again = bank.fit_noise(bank.innovations(model), first)
        if not again.likelihood > found.likelihood + SETTLED:
            break
        found = again
    return found


def _join(J: Sequence[Array], columns: Sequence[Array]) -> list[Array]:
    pairs = zip(J, columns, strict=True)
    return [np.concatenate([own.astype(more.dtype), more]) for own, more in pairs]


def _remainder(
    bank: FilterBank, e: Sequence[Array], columns: Sequence[Array], noise: Noise
) -> list[Array]:
    """Innovations (6, n) of each run less a likely combination of all columns (c, 6, n).

    Drawn from all that the data allow: the best combination takes as many numbers' worth of noise
    as there are columns, in short records nearly all of a slow disturbance. Short ones are drawn
    several times, all runs after one another.
    """
    target = bank.flatten([one[None] for one in e], noise)[0]
    white = bank.flatten(columns, noise)
    H = inner_products(white).astype(float)
    size = np.sqrt(np.diag(H))
    size[size == 0.0] = 1.0
    sure, turn = np.linalg.eigh(H / np.outer(size, size))
    sure = np.maximum(sure, 0.0) + SHRINK
    draws = -(-ENOUGH // len(target))
    # by the symmetric root: unlike eigenvectors it hardly changes with a rounding
    chance = turn.T @ np.random.default_rng(DRAW).normal(size=(draws, len(H))).T
    best = turn.T @ (white @ target / size) / sure
    likely = (turn @ (chance / np.sqrt(sure)[:, None] - best[:, None])).T / size
    return [
        one + np.tensordot(x, c, axes=1) for x in likely for one, c in zip(e, columns, strict=True)
    ]
