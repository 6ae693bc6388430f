"""Rank candidates to first order, and draw what chance alone would seem to explain."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.estimation.candidates import Candidate
from rovsim.estimation.observer.hypothesis import Term
from rovsim.estimation.observer.least_squares import Reduction, select_columns, solve_bounded
from rovsim.estimation.sensitivities import CandidateColumns

MAX_LINEAR_STEP = 3.0  # scales from its start: how far a first-order prediction is believed


@dataclass(frozen=True, eq=False)
class Proposal:
    """A term that may be worth adding.

    Attributes:
        term: at the values that a fit should start from.
        net_decrease: predicted decrease of the sum of squares, less the penalty of its parameters.
    """

    term: Term
    net_decrease: float


def rank_proposals(G: Array, blocks: Sequence[CandidateColumns], penalty: float) -> list[Proposal]:
    """Propose each effect at its best start, the most promising effect first.

    Args:
        G: Gram matrix (1 + c, 1 + c) of the innovations and all columns.
        blocks: which columns belong to which candidate.
        penalty: of each parameter.
    """
    by_id: dict[str, Proposal] = {}
    for block in blocks:
        reduction = _predict_reduction(G, block, penalty)
        term = _step(block.candidate, reduction)
        net_decrease = reduction.ss_decrease - penalty * term.choices
        previous = by_id.get(term.id)
        if previous is None or net_decrease > previous.net_decrease:
            by_id[term.id] = Proposal(term, net_decrease)
    return sorted(by_id.values(), key=lambda p: -p.net_decrease)


def _step(candidate: Candidate, reduction: Reduction) -> Term:
    """The term after a first-order step of the chosen parameters; thresholds do not move."""
    steps = dict(zip((candidate.sloped[j] for j in reduction.chosen), reduction.x, strict=True))
    thresholds = [p.name for p in candidate.thresholds]
    term = candidate.term([name for name in candidate.free if name in steps or name in thresholds])
    return term.at(term.x + [steps.get(name, 0.0) for name in term.free])


def _predict_reduction(G: Array, block: CandidateColumns, penalty: float) -> Reduction:
    index = [1 + j for j in block.derivatives]
    if block.secant is not None and not index:
        s = 1 + block.secant
        return Reduction(float(-2.0 * G[0, s] - G[s, s]), (), np.empty(0))
    H, b = G[np.ix_(index, index)], G[index, 0]
    if block.secant is None:
        return select_columns(H, b, penalty)
    s = 1 + block.secant
    low, high = block.candidate.term(block.candidate.sloped).step_limits(MAX_LINEAR_STEP)
    return solve_bounded(H, b + G[index, s], 2.0 * G[0, s] + G[s, s], low, high)


def draw_chance_decreases(
    G: Array, blocks: Sequence[CandidateColumns], penalty: float, draws: int, seed: int
) -> Array:
    """Draw the largest net decrease (draws,) that any candidate reaches by noise alone.

    Args:
        G: Gram matrix (c, c) of all columns.
        blocks: which columns belong to which candidate.
        penalty: of each parameter.
        draws: how many.
        seed: of the draws.
    """
    scale = _measure_lengths(G)
    values, vectors = np.linalg.eigh(G / np.outer(scale, scale))
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    z = np.random.default_rng(seed).normal(size=(draws, len(G))) @ root.T * scale
    largest = np.full(draws, -np.inf)
    for block in blocks:
        largest = np.maximum(largest, _chance_decreases(G, z, block, penalty))
    return largest


def _chance_decreases(G: Array, z: Array, block: CandidateColumns, penalty: float) -> Array:
    """Net decrease (draws,) by one candidate; z (draws, c) are products of noise and columns."""
    columns, s = list(block.derivatives), block.secant
    if s is None:  # the best of its columns alone
        return (
            np.max((z[:, columns] / np.sqrt(np.maximum(np.diag(G), 1e-300))[columns]) ** 2, axis=1)
            - penalty
        )
    if not columns:
        return -2.0 * z[:, s] - G[s, s] - penalty
    b = z[:, columns] + G[columns, s]
    x = np.linalg.lstsq(G[np.ix_(columns, columns)], b.T, rcond=1e-9)[0]
    return np.einsum("dk,kd->d", b, x) - 2.0 * z[:, s] - G[s, s] - penalty * len(columns)


def _measure_lengths(G: Array) -> Array:
    """Lengths (c,) of the columns with this Gram matrix."""
    return np.sqrt(np.maximum(np.diag(G), 1e-300))
