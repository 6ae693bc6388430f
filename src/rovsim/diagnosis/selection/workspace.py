"""The workspace of a search: the evidence, what it has fitted, and what looks worth trying next.

The price of a parameter is 2 log P for P columns to choose from (risk inflation criterion, Foster
& George 1994): chance alone rarely pays it, so a family of many members is not favoured over a
single number.
"""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.least_squares import Gain, greedy, inner_products, joint, without
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.selection.gauss_newton import Fit, fit
from rovsim.diagnosis.selection.sensitivities import Sensitivities, fit_remaining_noise
from rovsim.diagnosis.settings import SearchSettings

TRUSTED = 3.0  # scales: how far from its start a first-order guess is believed


@dataclass(frozen=True, eq=False)
class Proposal:
    """A term worth trying: what it should gain, its price paid, and where to start."""

    term: Term
    gain: float


@dataclass(frozen=True, eq=False)
class SearchWorkspace:
    """Everything a search looks at: the runs, the candidates' columns, and one noise for all."""

    bank: FilterBank
    sensitivities: Sensitivities
    noise: Noise
    settings: SearchSettings
    _fitted: dict[tuple, Fit] = field(default_factory=dict)
    _proposed: dict[tuple, list[Proposal]] = field(default_factory=dict)

    def renew(self, current: Fit) -> "SearchWorkspace":
        """The workspace whose filters and noise suit what is now known to act."""
        noise = fit_remaining_noise(self.sensitivities, current.hypothesis, current.noise)
        fresh = self.bank.redesign(current.hypothesis.model, noise)
        return SearchWorkspace(fresh, self.sensitivities, noise, self.settings)

    @cached_property
    def price(self) -> float:
        """What a free parameter costs, in twice the log likelihood."""
        return 2.0 * float(np.log(self.sensitivities.count))

    def fit(self, start: Hypothesis, reach: float = np.inf) -> Fit:
        """Fit under the common noise, as far as `reach`; the same start is fitted once."""
        key = start.key, reach
        if key not in self._fitted:
            self._fitted[key] = fit(start, self.bank, self.noise, reach)
        return self._fitted[key]

    def has_fitted(self, start: Hypothesis) -> bool:
        """Whether that start was fitted already, without a `reach`."""
        return (start.key, np.inf) in self._fitted

    def score(self, found: Fit) -> float:
        """Twice the log likelihood, the price of the free parameters paid."""
        return found.likelihood - self.price * len(found.hypothesis.x)

    @cached_property
    def columns(self) -> Array:
        """The candidates' columns (c, m), white."""
        return self.sensitivities.bank.coarsen(self.sensitivities.columns, self.noise)

    @cached_property
    def inner_products(self) -> Array:
        """Inner products (c, c) of the candidates' columns."""
        return inner_products(self.columns).astype(float)

    def products(self, current: Fit) -> Array:
        """Inner products (1 + c, 1 + c) of the innovations and the candidates' columns.

        What the free parameters of the current fit can explain is projected out of both.
        """
        pairs = zip(current.e, current.J, strict=True)
        stacked = [np.concatenate([e[None], J]) for e, J in pairs]
        own = self.bank.coarsen(stacked, self.noise)
        across = own @ self.columns.T
        M = np.block([[inner_products(own), across], [across.T, self.inner_products]])
        kept = [0, *range(len(own), len(M))]
        return without(M, range(1, len(own)))[np.ix_(kept, kept)]


def propose(workspace: SearchWorkspace, current: Fit) -> list[Proposal]:
    """All candidates, best first, judged to first order on top of what is there; made once.

    None where the observer cannot hold the current model.
    """
    if not np.isfinite(current.likelihood):
        return []
    key = current.hypothesis.key
    if key not in workspace._proposed:
        workspace._proposed[key] = _propose(workspace, current)
    return workspace._proposed[key]


def _propose(workspace: SearchWorkspace, current: Fit) -> list[Proposal]:
    M = workspace.products(current)
    best: dict[str, Proposal] = {}
    for candidate, secant, columns in zip(
        workspace.sensitivities.candidates,
        workspace.sensitivities.secant,
        workspace.sensitivities.derivatives,
        strict=True,
    ):
        gain = _gain(M, secant, columns, workspace.price, candidate.term())
        term = candidate.term([candidate.free[j] for j in gain.chosen])
        worth = gain.decrease - workspace.price * len(gain.chosen)
        proposal = Proposal(term.at(term.x + gain.x), worth)
        known = best.get(term.id)
        if known is None or worth > known.gain:
            best[term.id] = proposal
    return sorted(best.values(), key=lambda p: -p.gain)


def _gain(M: Array, secant: int | None, columns: Sequence[int], price: float, term: Term) -> Gain:
    own = [1 + j for j in columns]
    H, b = M[np.ix_(own, own)], M[own, 0]
    if secant is None:
        return greedy(H, b, price)
    s = 1 + secant
    low, high = term.reach(TRUSTED)
    return joint(H, b + M[own, s], 2.0 * M[0, s] + M[s, s], low, high)


def draw_chance_gains(workspace: SearchWorkspace, current: Fit, draws: int, seed: int) -> Array:
    """The best gain (draws,), price paid, that noise alone would give to any of the candidates."""
    M = workspace.products(current)[1:, 1:]
    scale = np.sqrt(np.maximum(np.diag(M), 1e-300))
    values, vectors = np.linalg.eigh(M / np.outer(scale, scale))
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    z = np.random.default_rng(seed).normal(size=(draws, len(M))) @ root.T * scale
    best = np.full(draws, -np.inf)
    for secant, columns in zip(
        workspace.sensitivities.secant, workspace.sensitivities.derivatives, strict=True
    ):
        own = list(columns)
        if secant is None:
            gains = np.max((z[:, own] / scale[own]) ** 2, axis=1) - workspace.price
        else:
            b = z[:, own] + M[own, secant]
            x = np.linalg.lstsq(M[np.ix_(own, own)], b.T, rcond=1e-9)[0]
            gains = np.einsum("dk,kd->d", b, x) - 2.0 * z[:, secant] - M[secant, secant]
            gains = gains - workspace.price * len(own)
        best = np.maximum(best, gains)
    return best
