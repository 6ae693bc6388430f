"""Which effects are missing: add the most likely one, refit all, try to swap, drop what is idle.

The price of a parameter is 2 log P for P columns to choose from (risk inflation criterion, Foster
& George 1994): chance alone rarely pays it, so a family of many members is not favoured over a
single number.
"""

from dataclasses import dataclass
from typing import Annotated, Sequence

import numpy as np
from numpy import ndarray as Array
from pydantic import Field, PositiveInt

from rovsim.diagnosis.evidence import Observatory
from rovsim.diagnosis.fit import Fit, fit
from rovsim.diagnosis.gram import Gain, coarse, greedy, inner_products, joint, without
from rovsim.diagnosis.hypothesis import Hypothesis, Term
from rovsim.diagnosis.library import Library
from rovsim.diagnosis.noise import Noise
from rovsim.diagnosis.windows import window_errors
from rovsim.model import Model
from rovsim.strict import Section

CLOSE = 0.2  # of the best predicted gain: less has never turned out best after refitting
TRUSTED = 3.0  # scales: how far from its start a first-order guess is believed


class SearchSettings(Section):
    """How effects are chosen.

    `false_alarm` is the chance of naming an effect where none is missing, per addition. `relevant`:
    an effect without which no axis' error in 2 s windows is larger by this share is left out,
    however sure it is: at that size the laboratory's clocks and roundings look like effects.
    """

    false_alarm: Annotated[float, Field(gt=0, lt=1)] = 0.01
    draws: PositiveInt = 1000  # of noise alone, for the best gain by chance
    trials: PositiveInt = 3
    most_effects: PositiveInt = 6
    relevant: Annotated[float, Field(ge=0)] = 0.02


@dataclass(frozen=True, eq=False)
class Proposal:
    """A term worth trying: what it should gain, its price paid, and where to start."""

    term: Term
    gain: float


@dataclass(frozen=True, eq=False)
class Desk:
    """Everything a search looks at; `trials` proposals are refitted before one is chosen."""

    observatory: Observatory
    library: Library
    noise: Noise
    price: float
    trials: int
    relevant: float

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


def worth_trying(desk: Desk, current: Fit, but: Sequence[str] = ()) -> list[Proposal]:
    """The proposals that could turn out best once refitted."""
    ranked = [p for p in proposals(desk, current) if p.term.id not in but and p.gain > 0.0]
    return [p for p in ranked[: desk.trials] if p.gain > CLOSE * ranked[0].gain]


def forward(desk: Desk, current: Fit, threshold: float) -> Fit | None:
    """The best single addition, refitted and pruned; None when none beats chance and matters."""
    tried = [desk.fit(current.hypothesis.with_term(p.term)) for p in worth_trying(desk, current)]
    for best in sorted(tried, key=desk.score, reverse=True):
        if desk.score(best) - desk.score(current) < threshold:
            break
        if matters(desk, best, current.hypothesis.model):
            return pruned(desk, best)
    return None


def matters(desk: Desk, found: Fit, without_it: Model) -> bool:
    """Whether some axis' error in 2 s windows is noticeably larger without an effect."""
    between, watches = desk.observatory.between, desk.observatory.watches
    rmse, _ = window_errors([found.hypothesis.model, without_it], watches, between)
    return float(np.max(rmse[1] / rmse[0])) - 1.0 > desk.relevant


@dataclass(frozen=True)
class Rival:
    """An effect that could stand in for a selected one, and by how much it is less likely.

    `deficit` is in twice the log likelihood, prices paid: 6 are odds of 20 to 1.
    """

    effect: str
    instead_of: str
    deficit: float


def contested(desk: Desk, current: Fit) -> tuple[Fit, list[Rival]]:
    """Replace any one term by another effect while that is more likely; then what comes close."""
    rivals = []
    for i, term in enumerate(current.hypothesis.terms):
        rest = desk.fit(current.hypothesis.without(i))
        for p in worth_trying(desk, rest, but=[term.id]):
            trial = desk.fit(rest.hypothesis.with_term(p.term))
            deficit = desk.score(current) - desk.score(trial)
            if deficit < 0.0:
                return contested(desk, pruned(desk, trial))
            rivals.append(Rival(p.term.id, term.id, deficit))
    return current, rivals


def search(desk: Desk, base: Fit, settings: SearchSettings, seed: int) -> tuple[Fit, list[Rival]]:
    """From the base to the model to which nothing can be added, swapped or taken away."""
    current: Fit = base
    rivals: list[Rival] = []
    while len(current.hypothesis.terms) < settings.most_effects:
        by_chance = chance(desk, current, settings.draws, seed)
        threshold = max(0.0, float(np.quantile(by_chance, 1.0 - settings.false_alarm)))
        found = forward(desk, current, threshold)
        if found is None:
            break
        current, rivals = contested(desk, found)
    return current, rivals
