"""The workspace of a search: the runs, what was fitted to them, and what is worth trying next.

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
from rovsim.estimation.file_effects import penalize_gain
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

HOPELESS_LR = 100.0  # less likely by a factor of e^50: how much less need not be known


@dataclass(frozen=True, eq=False)
class Removed:
    """A hypothesis without one of its terms, judged to first order.

    Attributes:
        hypothesis: without the term.
        gram: (1 + c, 1 + c) of the innovations that it leaves and of the candidates' columns, see
            `WhiteColumns.gram`.
        ss_increase: by how much the sum of squared innovations is larger without the term.
        others: all candidates as replacements of the term, the best first.
    """

    hypothesis: Hypothesis
    gram: Array
    ss_increase: float
    others: list[Proposal]


@dataclass(frozen=True, eq=False)
class SearchWorkspace:
    """Everything that a search works with; all its fits have the same filters and the same noise.

    Attributes:
        columns: how each candidate would change the innovations of the runs, whitened.
        settings: how the search decides.
    """

    columns: WhiteColumns
    settings: SearchSettings
    _fitted: dict[tuple, Fit] = field(default_factory=dict)
    _given_up: dict[tuple, float] = field(default_factory=dict)
    _proposed: dict[tuple, list[Proposal]] = field(default_factory=dict)
    _removed: dict[tuple, list[Removed]] = field(default_factory=dict)

    @property
    def bank(self) -> FilterBank:
        """The runs, and the filters of all fits."""
        return self.columns.bank

    @property
    def noise(self) -> Noise:
        """The noise under which all fits are made and compared."""
        return self.columns.noise

    @property
    def sensitivities(self) -> Sensitivities:
        """How each candidate would change the innovations."""
        return self.columns.sensitivities

    def update_after(self, current: Fit) -> "SearchWorkspace":
        """A workspace whose filters, columns and noise suit the effects accepted so far.

        Making the columns takes longest. They are only made anew when the number of accepted
        effects has doubled since. The workspace stays as it is where the model would diverge.
        """
        h = current.hypothesis
        made_with = len(self.columns.sensitivities_at(h).added_ids)
        workspace = self.relinearise_if_changed(current) if len(h.terms) >= 2 * made_with else self
        sensitivities = workspace.columns.sensitivities_at(h)
        if not sensitivities.is_finite:
            return self
        return workspace.with_noise(h, fit_remaining_noise(sensitivities, h, self.noise, rounds=1))

    def relinearise_if_changed(self, current: Fit) -> "SearchWorkspace":
        """A workspace whose candidates are linearised with the accepted effects in place.

        It stays as it is where these effects hardly change the columns, or the model diverges.
        """
        at, names = current.hypothesis, {term.id for term in current.hypothesis.terms}
        up_to_date = names == set(self.columns.sensitivities_at(at).added_ids)
        if up_to_date or not self.columns.have_changed(current.linearised):
            return self
        columns = self.columns.relinearised(at)
        if not columns.sensitivities_at(at).is_finite:
            return self
        return replace(self, columns=columns, _proposed={}, _removed={})

    def with_noise(self, at: Hypothesis, noise: Noise) -> "SearchWorkspace":
        """A workspace whose filters suit another hypothesis and noise.

        Where axes drive each other, the columns cannot be converted to another noise. They are then
        made anew, and the noise is fitted to what they leave.
        """
        bank = self.bank.redesign(at.model, noise)
        if not bank.coupled:
            return SearchWorkspace(self.columns.under(bank, noise), self.settings)
        base = Hypothesis(self.sensitivities.base_model)
        sensitivities = linearise_candidates(bank, base, self.sensitivities.candidates)
        noise = fit_remaining_noise(sensitivities, at, noise, rounds=1)
        return SearchWorkspace(WhiteColumns(bank, sensitivities, noise), self.settings)

    def on_runs(self, bank: FilterBank, noise: Noise) -> "SearchWorkspace":
        """A workspace that fits to other runs, with the same candidates and the same penalty.

        The candidates' columns remain those of the runs that they were made on.
        """
        return SearchWorkspace(WhiteColumns(bank, self.sensitivities, noise), self.settings)

    @cached_property
    def penalty(self) -> float:
        """Penalty of a free parameter, to be subtracted from a likelihood-ratio statistic."""
        return 2.0 * float(np.log(self.sensitivities.count))

    def fit(self, start: Hypothesis, prior_std: float = np.inf) -> Fit:
        """Fit a hypothesis under the common noise; the same start is fitted only once.

        `prior_std` is that of a prior about the start, in scales (see `estimation.fit`).
        """
        key = start.key, prior_std
        if key not in self._fitted:
            self._fitted[key] = fit(start, self.bank, self.noise, prior_std)
        return self._fitted[key]

    def fit_unless_worse(
        self, start: Hypothesis, current: Fit, score: float, prior_std: float = np.inf
    ) -> Fit | None:
        """As `fit`, but None as soon as its score will surely be `HOPELESS_LR` below another.

        Args:
            start: the hypothesis to fit.
            current: a fit whose derivatives are taken at first, as far as they have the same
                parameters.
            score: to compare with.
            prior_std: see `fit`.
        """
        key, threshold = (start.key, prior_std), score - HOPELESS_LR + self._penalty_of(start)
        if key not in self._fitted and threshold < self._given_up.get(key, np.inf):
            linearised = self.bank.linearise(start, current.linearised)
            result = fit_or_give_up(linearised, self.bank, self.noise, threshold, prior_std)
            if result is None:
                self._given_up[key] = threshold
            else:
                self._fitted[key] = result
        return self._fitted.get(key)

    def has_fitted(self, start: Hypothesis) -> bool:
        """Whether that start was fitted already, without a prior."""
        return (start.key, np.inf) in self._fitted

    def score(self, fit: Fit) -> float:
        """Twice the log likelihood of a fit, less its penalties: what fits are compared by.

        There is a penalty for each free parameter, and one for a gain of the thrusters that is
        far from the file's.
        """
        return fit.two_log_likelihood - self._penalty_of(fit.hypothesis)

    def _penalty_of(self, at: Hypothesis) -> float:
        """The penalties of a hypothesis."""
        return self.penalty * sum(t.choices for t in at.terms) + penalize_gain(at)

    def remove_each(self, current: Fit) -> list[Removed]:
        """Without each term of the current hypothesis in turn, the others refitted to first order.

        The result is kept, since swaps are tried one after the other.
        """
        key = current.hypothesis.key
        if key not in self._removed:
            self._removed[key] = self._remove_each(current)
        return self._removed[key]

    def _remove_each(self, current: Fit) -> list[Removed]:
        removed, rss = [], float(self.columns.gram(current.linearised)[0, 0])
        for linearised in self._without(current, [(term,) for term in current.hypothesis.terms]):
            G = self.columns.gram(linearised)
            removed.append(Removed(linearised.hypothesis, G, float(G[0, 0]) - rss, self._rank(G)))
        return removed

    def gram_without(self, current: Fit, term: Term) -> Array:
        """The Gram matrix of the current hypothesis without one of its terms."""
        if removals := self._removed.get(current.hypothesis.key):
            return removals[current.hypothesis.terms.index(term)].gram
        return self.columns.gram(self._without(current, [(term,)])[0])

    def drop(self, current: Fit, groups: Sequence[Sequence[Term]]) -> list[Hypothesis]:
        """Without each group of terms in turn, the other terms refitted to first order.

        Where the model without the group diverges, the other terms keep their values.
        """
        return [self._step(linearised) for linearised in self._without(current, groups)]

    def _step(self, seen: Linearised) -> Hypothesis:
        """The hypothesis at the values for which a Gauss-Newton step predicts the least errors."""
        if not seen.is_finite:
            return seen.hypothesis
        step = newton_step(gram(self.bank.flatten(seen.rows, self.noise)))
        return seen.hypothesis.at(seen.hypothesis.x + step)

    def _without(self, current: Fit, groups: Sequence[Sequence[Term]]) -> list[Linearised]:
        """Without each group of terms in turn: innovations anew, derivatives of the current fit."""
        h, J = current.hypothesis, current.linearised.J
        hypotheses = [
            replace(h, terms=tuple(t for t in h.terms if t not in group)) for group in groups
        ]
        e = self.bank.evaluate([r.model for r in hypotheses])
        linearised = []
        for k, (hypothesis, group) in enumerate(zip(hypotheses, groups, strict=True)):
            pairs = zip(h.terms, h.columns, strict=True)
            positions = [j for term, columns in pairs if term in group for j in columns]
            J_reduced = [np.delete(of_run, positions, axis=0) for of_run in J]
            linearised.append(Linearised(hypothesis, [of_run[k] for of_run in e], J_reduced))
        return linearised

    def _rank(self, G: Array) -> list[Proposal]:
        """All candidates, the best first; none where the model diverges."""
        if not np.isfinite(G).all():
            return []
        return rank_proposals(G, self.sensitivities.blocks, self.penalty)

    def list_modes(self, term: Term) -> list[Term]:
        """Starts of the same effect in its other modes, with the same parameters free."""
        if all(p.fitted for p in term.effect.parameters):
            return []
        starts = [block.candidate.term() for block in self.sensitivities.blocks]
        return [t for t in starts if t.id == term.id and t.free and set(t.free) == set(term.free)]

    def propose(self, current: Fit) -> list[Proposal]:
        """All candidates as additions to the current fit, judged to first order, the best first.

        None where the current model diverges.
        """
        if not current.is_finite:
            return []
        key = current.hypothesis.key
        if key not in self._proposed:
            self._proposed[key] = self._rank(self.columns.gram(current.linearised))
        return self._proposed[key]

    def chance_limit(self, current: Fit, seed: int) -> float:
        """The net decrease that the best candidate reaches by chance in all but the allowed cases.

        From draws of noise alone; `settings.false_alarm` is the share of the draws that exceed it.
        """
        G = self.columns.gram(current.linearised)[1:, 1:]
        if not np.isfinite(G).all():
            return np.inf  # the model diverges, and nothing can be said of additions to it
        decreases = draw_chance_decreases(
            G, self.sensitivities.blocks, self.penalty, self.settings.draws, seed
        )
        return max(0.0, float(np.quantile(decreases, 1.0 - self.settings.false_alarm)))

    def find_relevant(self, fit: Fit, without: Sequence[Model]) -> Array:
        """For each of m smaller models, whether some axis' error in 2 s windows is clearly larger.

        `settings.relevant` is the share by which it has to be larger than that of `fit`.
        """
        rmse = score_windows([fit.hypothesis.model, *without], self.bank.runs).rmse
        axes = rmse[0] > 0.0
        # a model that cannot exist is infinitely worse
        ratio = np.nan_to_num(rmse[1:, axes] / rmse[0, axes], nan=np.inf)
        return np.max(ratio, axis=1, initial=0.0) - 1.0 > self.settings.relevant
