"""Which effects are missing: add the most likely one, refit all, try to swap, drop what is idle.

The price of a parameter is 2 log P for P columns to choose from (risk inflation criterion, Foster
& George 1994): chance alone rarely pays it, so a family of many members is not favoured over a
single number.
"""

from dataclasses import dataclass, field
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.evidence import Observatory
from rovsim.diagnosis.fit import Fit, fit
from rovsim.diagnosis.gram import Gain, greedy, inner_products, joint, without
from rovsim.diagnosis.hypothesis import Hypothesis, Term
from rovsim.diagnosis.library import Library
from rovsim.diagnosis.noise import Noise

FEW = 4
TRUSTED = 3.0  # scales: how far from its start a first-order guess is believed


@dataclass(frozen=True, eq=False)
class Proposal:
    """A term worth trying: what it should gain, its price paid, and where to start."""

    term: Term
    gain: float


@dataclass(frozen=True, eq=False)
class Desk:
    """Everything a search looks at."""

    observatory: Observatory
    library: Library
    noise: Noise
    price: float
    trials: int = 3
    log: list[str] = field(default_factory=list)

    def fit(self, hypothesis: Hypothesis) -> Fit:
        """Fit under the common noise."""
        return fit(hypothesis, self.observatory, self.noise)

    def score(self, found: Fit) -> float:
        """Twice the log likelihood, the price of the free parameters paid."""
        return found.likelihood - self.price * len(found.hypothesis.x)


def products(desk: Desk, current: Fit, noise: Noise) -> tuple[Array, int, int]:
    """Inner products of innovations, current columns and library, whitened; and the two offsets."""
    stacked = [
        np.concatenate([e[None], J, columns])
        for e, J, columns in zip(current.e, current.J, desk.library.columns, strict=True)
    ]
    white = coarse(desk.observatory.white(stacked, noise))
    return inner_products(white.reshape(len(white), -1)), 1, 1 + len(current.J[0])


def coarse(white: Array) -> Array:
    """Means of a few neighbours (..., n // few), still of unit variance.

    What a vehicle of this size does is slower than 10 Hz; frames come ten times as fast.
    """
    n = white.shape[-1] // FEW * FEW
    return white[..., :n].reshape(*white.shape[:-1], -1, FEW).sum(axis=-1) / np.sqrt(FEW)


def proposals(desk: Desk, current: Fit) -> list[Proposal]:
    """All candidates, best first, judged to first order on top of what is there."""
    M, c, at = products(desk, current, desk.noise)
    M = without(M, range(c, at))
    best: dict[str, Proposal] = {}
    for candidate, secant, columns in zip(
        desk.library.candidates, desk.library.secant, desk.library.derivatives, strict=True
    ):
        gain = _gain(M, at, secant, columns, desk.price, candidate.term())
        term = candidate.term([candidate.free[j] for j in gain.chosen])
        worth = gain.decrease - desk.price * len(gain.chosen)
        proposal = Proposal(term.at(term.x + gain.x), worth)
        known = best.get(term.id)
        if known is None or worth > known.gain:
            best[term.id] = proposal
    return sorted(best.values(), key=lambda p: -p.gain)


def _gain(
    M: Array, at: int, secant: int | None, columns: Sequence[int], price: float, term: Term
) -> Gain:
    own = [at + j for j in columns]
    H, b = M[np.ix_(own, own)], M[own, 0]
    if secant is None:
        return greedy(H, b, price)
    s = at + secant
    low, high = term.reach(TRUSTED)
    return joint(H, b + M[own, s], 2.0 * M[0, s] + M[s, s], low, high)


def chance(desk: Desk, current: Fit, draws: int, seed: int) -> Array:
    """The best gain (draws,), price paid, that noise alone would give to any of the candidates."""
    M, c, at = products(desk, current, current.noise)
    M = without(M, range(c, at))[at:, at:]
    scale = np.sqrt(np.maximum(np.diag(M), 1e-300))
    values, vectors = np.linalg.eigh(M / np.outer(scale, scale))
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    z = np.random.default_rng(seed).normal(size=(draws, len(M))) @ root.T * scale
    best = np.full(draws, -np.inf)
    for secant, columns in zip(desk.library.secant, desk.library.derivatives, strict=True):
        own = list(columns)
        if secant is None:
            gains = np.max(z[:, own] ** 2 / np.diag(M)[own], axis=1) - desk.price
        else:
            b = z[:, own] + M[own, secant]
            x = np.linalg.lstsq(M[np.ix_(own, own)], b.T, rcond=1e-9)[0]
            gains = np.einsum("dk,kd->d", b, x) - 2.0 * z[:, secant] - M[secant, secant]
            gains = gains - desk.price * len(own)
        best = np.maximum(best, gains)
    return best


def pruned(desk: Desk, current: Fit) -> Fit:
    """Without free parameters that are not worth their price, one at a time."""
    while len(current.hypothesis.x):
        smaller = _weakest_dropped(desk, current)
        if smaller is None:
            return current
        trial = desk.fit(smaller)
        if desk.score(trial) < desk.score(current):
            return current
        desk.log.append(f"dropped: now {trial.hypothesis.names}")
        current = trial
    return current


def _weakest_dropped(desk: Desk, current: Fit) -> Hypothesis | None:
    """The hypothesis without its least certain parameter that starts from absence."""
    h, k, weakest, least = current.hypothesis, 0, None, 2.0 * desk.price
    for i, term in enumerate(h.terms):
        for p in term.parameters:
            z = (h.x[k] - p.default / p.scale) / max(current.std[k], 1e-12)
            k += 1
            if z**2 < least:
                smaller = _without_parameter(h, i, p.name)
                weakest, least = smaller, z**2
    return weakest


def _without_parameter(h: Hypothesis, i: int, name: str) -> Hypothesis:
    term = h.terms[i]
    left = tuple(n for n in term.free if n != name)
    if not left or {} not in term.effect.starts:
        return h.without(i)
    default = next(p.default for p in term.effect.parameters if p.name == name)
    smaller = Term(term.effect.with_values({name: default}), left)
    return Hypothesis(h.base, (*h.terms[:i], smaller, *h.terms[i + 1 :]))


def forward(desk: Desk, current: Fit, threshold: float) -> Fit | None:
    """The best single addition, refitted; None when none is better than chance."""
    ranked = [p for p in proposals(desk, current) if p.gain > 0.0][: desk.trials]
    tried = [desk.fit(current.hypothesis.with_term(p.term)) for p in ranked]
    for p, t in zip(ranked, tried):
        desk.log.append(f"  try {p.term.id} {p.term.free} predicted {p.gain:.1f} got {desk.score(t)-desk.score(current):.1f} {p.term.effect!r} -> {t.hypothesis.terms[-1].effect!r}")
    best = max(tried, key=desk.score, default=None)
    if best is None or desk.score(best) - desk.score(current) < threshold:
        return None
    return best


def swapped(desk: Desk, current: Fit) -> Fit:
    """Replace any one term by any other effect while that is more likely."""
    for i in range(len(current.hypothesis.terms)):
        rest = desk.fit(current.hypothesis.without(i))
        gone = current.hypothesis.terms[i].id
        ranked = [p for p in proposals(desk, rest) if p.term.id != gone and p.gain > 0.0]
        for p in ranked[: desk.trials - 1]:
            trial = desk.fit(rest.hypothesis.with_term(p.term))
            desk.log.append(f"  swap {gone} by {p.term.id} {desk.score(trial)-desk.score(current):.1f}")
            if desk.score(trial) > desk.score(current):
                return swapped(desk, trial)
    return current
