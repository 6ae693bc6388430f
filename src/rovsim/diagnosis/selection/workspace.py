"""The workspace of a search: the evidence, what it has fitted, and what looks worth trying next.

The penalty of a parameter is 2 log P for P columns to choose from (risk inflation criterion, Foster
& George 1994): chance alone rarely pays it, so a family of many members is not favoured over a
single number.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.proposals import Proposal, draw_chance_decreases, rank_proposals
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import doubt_gain
from rovsim.estimation.fit import Fit, fit, fit_or_give_up
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.least_squares import gram, newton_step
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.residual_source import Linearised
from rovsim.estimation.observer.windows import score_windows
from rovsim.estimation.remaining_noise import fit_remaining_noise
from rovsim.estimation.sensitivities import Sensitivities, linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns

HOPELESS_LR = 100.0  # what is less likely by e^50 need not be known better


@dataclass(frozen=True, eq=False)
class Removed:
    """A hypothesis without one of its terms, judged to first order.

    `gram` (1 + c, 1 + c) as of `WhiteColumns`; `ss_increase`: increase of the sum of squares;
    `others`: all candidates for what the term took, best first.
    """

    hypothesis: Hypothesis
    gram: Array
    ss_increase: float
    others: list[Proposal]


@dataclass(frozen=True, eq=False)
class SearchWorkspace:
    """Everything a search looks at: the runs, the candidates' columns, and one noise for all."""

    columns: WhiteColumns
    settings: SearchSettings
    _fitted: dict[tuple, Fit] = field(default_factory=dict)
    _given_up: dict[tuple, float] = field(default_factory=dict)
    _proposed: dict[tuple, list[Proposal]] = field(default_factory=dict)
    _removed: dict[tuple, list[Removed]] = field(default_factory=dict)

    @property
    def bank(self) -> FilterBank:
        """The filters that all fits have."""
        return self.columns.bank

    @property
    def noise(self) -> Noise:
        """What all of them are judged under."""
        return self.columns.noise

    @property
    def sensitivities(self) -> Sensitivities:
        """What each candidate would change."""
        return self.columns.sensitivities

    def update_after(self, current: Fit) -> "SearchWorkspace":
        """The workspace whose filters, columns and noise suit what is now known to act.

        Columns take longest: they are made anew each time that twice as much was found. The same
        where filters under the noise that was known do not hold the model.
        """
        at, beside = current.hypothesis, self.columns.beside(current.hypothesis).beside
        fresh = self.relinearise_if_changed(current) if len(at.terms) >= 2 * len(beside) else self
        known = fresh.columns.beside(at)
        if not known.finite:
            return self
        return fresh.with_noise(at, fit_remaining_noise(known, at, self.noise, rounds=1))

    def relinearise_if_changed(self, current: Fit) -> "SearchWorkspace":
        """The workspace with columns beside all that was found, where that has changed them.

        The same where its filters do not hold that.
        """
        at, names = current.hypothesis, {term.id for term in current.hypothesis.terms}
        known = names == set(self.columns.beside(at).beside)
        if known or not self.columns.have_changed(current.linearised):
            return self
        columns = self.columns.relinearised(at)
        if not columns.beside(at).finite:
            return self
        return replace(self, columns=columns, _proposed={}, _removed={})

    def with_noise(self, at: Hypothesis, noise: Noise) -> "SearchWorkspace":
        """The workspace whose filters suit a hypothesis and a noise.

        Where axes drive each other, columns of another noise do not do: they are made anew, and the
        noise is fitted to them.
        """
        bank = self.bank.redesign(at.model, noise)
        if not bank.coupled:
            return SearchWorkspace(self.columns.under(bank, noise), self.settings)
        base = Hypothesis(self.sensitivities.base_model)
        fresh = linearise_candidates(bank, base, self.sensitivities.candidates)
        noise = fit_remaining_noise(fresh, at, noise, rounds=1)
        return SearchWorkspace(WhiteColumns(bank, fresh, noise), self.settings)

    def on_runs(self, bank: FilterBank, noise: Noise) -> "SearchWorkspace":
        """The same penalties, for fits to other runs; candidates are still judged by its own."""
        return SearchWorkspace(WhiteColumns(bank, self.sensitivities, noise), self.settings)

    @cached_property
    def penalty(self) -> float:
        """What a free parameter costs, as a likelihood-ratio statistic."""
        return 2.0 * float(np.log(self.sensitivities.count))

    def fit(self, start: Hypothesis, reach: float = np.inf) -> Fit:
        """Fit under the common noise, as far as `reach`; the same start is fitted once."""
        key = start.key, reach
        if key not in self._fitted:
            self._fitted[key] = fit(start, self.bank, self.noise, reach)
        return self._fitted[key]

    def fit_unless_worse(
        self, start: Hypothesis, current: Fit, score: float, reach: float = np.inf
    ) -> Fit | None:
        """The same, but None as soon as it surely scores `HOPELESS_LR` less than that.

        `current`: a fit whose derivatives it may begin with.
        """
        key, least = (start.key, reach), score - HOPELESS_LR + self._penalty_of(start)
        if key not in self._fitted and least < self._given_up.get(key, np.inf):
            first = self.bank.linearise(start, current.linearised)
            fitted = fit_or_give_up(first, self.bank, self.noise, least, reach)
            if fitted is None:
                self._given_up[key] = least
            else:
                self._fitted[key] = fitted
        return self._fitted.get(key)

    def has_fitted(self, start: Hypothesis) -> bool:
        """Whether that start was fitted already, without a `reach`."""
        return (start.key, np.inf) in self._fitted

    def score(self, fit: Fit) -> float:
        """Its 2 log L, less the penalty of the free parameters, and an odd gain."""
        return fit.two_log_likelihood - self._penalty_of(fit.hypothesis)

    def _penalty_of(self, at: Hypothesis) -> float:
        """What a hypothesis costs."""
        return self.penalty * sum(t.choices for t in at.terms) + doubt_gain(at)

    def remove_each(self, current: Fit) -> list[Removed]:
        """The current hypothesis without each of its terms, the others refitted to first order.

        Made once, as swaps are tried one after the other.
        """
        key = current.hypothesis.key
        if key not in self._removed:
            self._removed[key] = self._remove_each(current)
        return self._removed[key]

    def _remove_each(self, current: Fit) -> list[Removed]:
        removed, left = [], float(self.columns.gram(current.linearised)[0, 0])
        for seen in self._without(current, [(term,) for term in current.hypothesis.terms]):
            G = self.columns.gram(seen)
            removed.append(Removed(seen.hypothesis, G, float(G[0, 0]) - left, self._rank(G)))
        return removed

    def gram_without(self, current: Fit, term: Term) -> Array:
        """The Gram matrix of the current hypothesis without one of its terms."""
        if known := self._removed.get(current.hypothesis.key):
            return known[current.hypothesis.terms.index(term)].gram
        return self.columns.gram(self._without(current, [(term,)])[0])

    def drop(self, current: Fit, groups: Sequence[Sequence[Term]]) -> list[Hypothesis]:
        """The current hypothesis without each group of terms, the others refitted to first order.

        Others stay as they are where the observer cannot hold the model without the group.
        """
        return [self._step(seen) for seen in self._without(current, groups)]

    def _step(self, seen: Linearised) -> Hypothesis:
        """Where the derivatives say that the errors are least."""
        if not seen.finite:
            return seen.hypothesis
        step = newton_step(gram(self.bank.flatten(seen.rows, self.noise)))
        return seen.hypothesis.at(seen.hypothesis.x + step)

    def _without(self, current: Fit, groups: Sequence[Sequence[Term]]) -> list[Linearised]:
        """The current hypothesis without each group of terms, the derivatives as they were."""
        h, J = current.hypothesis, current.linearised.J
        rests = [replace(h, terms=tuple(t for t in h.terms if t not in own)) for own in groups]
        e = self.bank.evaluate([one.model for one in rests])
        linearised = []
        for k, (rest, own) in enumerate(zip(rests, groups, strict=True)):
            each = zip(h.terms, h.columns, strict=True)
            gone = [j for term, columns in each if term in own for j in columns]
            left = [np.delete(of_run, gone, axis=0) for of_run in J]
            linearised.append(Linearised(rest, [of_run[k] for of_run in e], left))
        return linearised

    def _rank(self, G: Array) -> list[Proposal]:
        """All candidates, best first; none where the observer cannot hold the model."""
        if not np.isfinite(G).all():
            return []
        return rank_proposals(G, self.sensitivities.blocks, self.penalty)

    def list_modes(self, term: Term) -> list[Term]:
        """Starts of the same effect, if it has modes, with the same free values."""
        if all(p.fitted for p in term.effect.parameters):
            return []
        starts = [block.candidate.term() for block in self.sensitivities.blocks]
        return [
            one
            for one in starts
            if one.id == term.id and one.free and set(one.free) == set(term.free)
        ]

    def propose(self, current: Fit) -> list[Proposal]:
        """All candidates, best first, judged to first order on top of what is there; made once.

        None where the observer cannot hold the current model.
        """
        if not current.is_finite:
            return []
        key = current.hypothesis.key
        if key not in self._proposed:
            self._proposed[key] = self._rank(self.columns.gram(current.linearised))
        return self._proposed[key]

    def chance_limit(self, current: Fit, seed: int) -> float:
        """Net decrease by the best candidate where all is chance, but for false alarms allowed."""
        G = self.columns.gram(current.linearised)[1:, 1:]
        if not np.isfinite(G).all():
            return np.inf  # the observer cannot hold the model, and nothing can be told
        decreases = draw_chance_decreases(
            G, self.sensitivities.blocks, self.penalty, self.settings.draws, seed
        )
        return max(0.0, float(np.quantile(decreases, 1.0 - self.settings.false_alarm)))

    def find_relevant(self, fit: Fit, without: Sequence[Model]) -> Array:
        """Whether some axis' error in 2 s windows is noticeably larger with each model (m,)."""
        rmse = score_windows([fit.hypothesis.model, *without], self.bank.runs).rmse
        measured = rmse[0] > 0.0
        # a model that cannot exist is infinitely worse
        ratio = np.nan_to_num(rmse[1:, measured] / rmse[0, measured], nan=np.inf)
        return np.max(ratio, axis=1, initial=0.0) - 1.0 > self.settings.relevant
