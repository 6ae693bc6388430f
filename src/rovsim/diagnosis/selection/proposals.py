"""What looks worth adding, judged to first order, and what chance alone would seem to gain."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.hypothesis import Term
from rovsim.diagnosis.observer.least_squares import Gain, select_columns, solve_bounded
from rovsim.diagnosis.selection.sensitivities import CandidateColumns

TRUSTED = 3.0  # scales: how far from its start a first-order guess is believed


@dataclass(frozen=True, eq=False)
class Proposal:
    """A term worth trying: what it should gain, with its penalty, and where to start."""

    term: Term
    gain: float


def rank_proposals(M: Array, blocks: Sequence[CandidateColumns], penalty: float) -> list[Proposal]:
    """The best start of each effect, the most promising effect first.

    Args:
        M: inner products (1 + c, 1 + c) of the innovations and all columns.
        blocks: which columns are whose.
        penalty: of a parameter, in twice the log likelihood.
    """
    best: dict[str, Proposal] = {}
    for block in blocks:
        gain = _predict_gain(M, block, penalty)
        candidate = block.candidate
        term = candidate.term([candidate.free[j] for j in gain.chosen])
        worth = gain.decrease - penalty * term.choices
        known = best.get(term.id)
        if known is None or worth > known.gain:
            best[term.id] = Proposal(term.at(term.x + gain.x), worth)
    return sorted(best.values(), key=lambda one: -one.gain)


def _predict_gain(M: Array, block: CandidateColumns, penalty: float) -> Gain:
    own = [1 + j for j in block.derivatives]
    if block.secant is not None and not own:
        s = 1 + block.secant
        return Gain(float(-2.0 * M[0, s] - M[s, s]), (), np.empty(0))
    H, b = M[np.ix_(own, own)], M[own, 0]
    if block.secant is None:
        return select_columns(H, b, penalty)
    s = 1 + block.secant
    low, high = block.candidate.term().reach(TRUSTED)
    return solve_bounded(H, b + M[own, s], 2.0 * M[0, s] + M[s, s], low, high)


def draw_chance_gains(
    M: Array, blocks: Sequence[CandidateColumns], penalty: float, draws: int, seed: int
) -> Array:
    """The best gain (draws,), less its penalty, that noise alone would give to any candidate.

    Args:
        M: inner products (c, c) of all columns.
        blocks: which columns are whose.
        penalty: of a parameter, in twice the log likelihood.
        draws: how many.
        seed: of the draws.
    """
    scale = _sizes(M)
    values, vectors = np.linalg.eigh(M / np.outer(scale, scale))
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    z = np.random.default_rng(seed).normal(size=(draws, len(M))) @ root.T * scale
    best = np.full(draws, -np.inf)
    for block in blocks:
        best = np.maximum(best, _chance_gains(M, z, block, penalty))
    return best


def _chance_gains(M: Array, z: Array, block: CandidateColumns, penalty: float) -> Array:
    """What one candidate would gain (draws,) from drawn products (draws, c) with its columns."""
    own, s = list(block.derivatives), block.secant
    if s is None:  # the best of its columns alone
        return (
            np.max((z[:, own] / np.sqrt(np.maximum(np.diag(M), 1e-300))[own]) ** 2, axis=1)
            - penalty
        )
    if not own:
        return -2.0 * z[:, s] - M[s, s] - penalty
    b = z[:, own] + M[own, s]
    x = np.linalg.lstsq(M[np.ix_(own, own)], b.T, rcond=1e-9)[0]
    return np.einsum("dk,kd->d", b, x) - 2.0 * z[:, s] - M[s, s] - penalty * len(own)


def _sizes(M: Array) -> Array:
    """Lengths (c,) of the columns with these inner products."""
    return np.sqrt(np.maximum(np.diag(M), 1e-300))
