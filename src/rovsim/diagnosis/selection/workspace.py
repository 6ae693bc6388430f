"""The workspace of a search: the runs, what was fitted to them, and what is worth trying next."""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.first_order import FirstOrder
from rovsim.diagnosis.selection.fit_cache import FitCache
from rovsim.diagnosis.selection.proposals import draw_chance_decreases
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import penalize_gain
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.observer.windows import score_windows
from rovsim.estimation.remaining_noise import fit_remaining_noise
from rovsim.estimation.sensitivities import Sensitivities, linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns

HOPELESS_LR = 100.0  # less likely by a factor of e^50: how much less need not be known


@dataclass(frozen=True, eq=False)
class SearchWorkspace:
    """Everything that a search works with; all its fits have the same filters and the same noise.

    Attributes:
        first_order: the candidates' columns, and what they say of additions and removals.
        settings: how the search decides.
        fits: what was fitted already; it outlives the columns, which may be made anew.
    """

    first_order: FirstOrder
    settings: SearchSettings
    fits: FitCache

    @staticmethod
    def begin(columns: WhiteColumns, settings: SearchSettings) -> "SearchWorkspace":
        """A workspace in which nothing was fitted yet.

        Args:
            columns: how each candidate would change the innovations of the runs, whitened.
            settings: how the search decides.
        """
        return SearchWorkspace(FirstOrder(columns), settings, FitCache(columns.bank, columns.noise))

    @property
    def columns(self) -> WhiteColumns:
        """How each candidate would change the innovations of the runs, whitened."""
        return self.first_order.columns

    @property
    def penalty(self) -> float:
        """Penalty of a free parameter, to be subtracted from a likelihood-ratio statistic."""
        return self.first_order.penalty

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

    def refit_updated(self, fit: Fit, prior_std: float = np.inf) -> tuple["SearchWorkspace", Fit]:
        """A fit, refitted with filters, columns and noise that suit it.

        Weaker corrections may let the model diverge; both then stay as they are.
        """
        updated = self.update_after(fit)
        refit = updated.fit(fit.hypothesis, prior_std)
        return (updated, refit) if refit.is_finite else (self, fit)

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
        return replace(self, first_order=FirstOrder(columns))

    def with_noise(self, at: Hypothesis, noise: Noise) -> "SearchWorkspace":
        """A workspace whose filters suit another hypothesis and noise.

        Where axes drive each other, the columns cannot be converted to another noise. They are then
        made anew, and the noise is fitted to what they leave.
        """
        bank = self.bank.redesign(at.model, noise)
        if not bank.coupled:
            return SearchWorkspace.begin(self.columns.under(bank, noise), self.settings)
        base = Hypothesis(self.sensitivities.base_model)
        sensitivities = linearise_candidates(bank, base, self.sensitivities.candidates)
        noise = fit_remaining_noise(sensitivities, at, noise, rounds=1)
        return SearchWorkspace.begin(WhiteColumns(bank, sensitivities, noise), self.settings)

    def on_runs(self, bank: FilterBank, noise: Noise) -> "SearchWorkspace":
        """A workspace that fits to other runs, with the same candidates and the same penalty.

        The candidates' columns remain those of the runs that they were made on.
        """
        return SearchWorkspace.begin(WhiteColumns(bank, self.sensitivities, noise), self.settings)

    def fit(self, start: Hypothesis, prior_std: float = np.inf) -> Fit:
        """Fit a hypothesis under the common noise; the same start is fitted only once.

        `prior_std` is that of a prior about the start, in scales (see `estimation.fit`).
        """
        return self.fits.fit(start, prior_std)

    def fit_unless_below(
        self, start: Hypothesis, current: Fit, least: float, prior_std: float = np.inf
    ) -> Fit | None:
        """As `fit`, but None as soon as its score will surely not reach `least`.

        Args:
            start: the hypothesis to fit.
            current: a fit whose derivatives are taken at first, as far as they have the same
                parameters.
            least: score to be reached.
            prior_std: see `fit`.
        """
        least_likelihood = least + self._penalty_of(start)
        return self.fits.fit_or_give_up(start, current, least_likelihood, prior_std)

    def score(self, fit: Fit) -> float:
        """Twice the log likelihood of a fit, less its penalties: what fits are compared by.

        There is a penalty for each free parameter, and one for a gain of the thrusters that is
        far from the file's.
        """
        return fit.two_log_likelihood - self._penalty_of(fit.hypothesis)

    def weigh_term(self, fit: Fit, i: int) -> float:
        """How far a term is from its absence (Wald's statistic), in units of its penalty."""
        h = fit.hypothesis
        return fit.wald_statistic(h.columns[i]) / (self.penalty * h.terms[i].choices)

    def _penalty_of(self, at: Hypothesis) -> float:
        """The penalties of a hypothesis."""
        return self.penalty * sum(t.choices for t in at.terms) + penalize_gain(at)

    def list_modes(self, term: Term) -> list[Term]:
        """Starts of the same effect in its other modes, with the same parameters free."""
        if all(p.fitted for p in term.effect.parameters):
            return []
        return [t for t in self.list_starts(term) if t.free and set(t.free) == set(term.free)]

    def list_starts(self, term: Term) -> list[Term]:
        """Where fits of the same effect begin, in the order of the candidates."""
        starts = [block.candidate.term() for block in self.sensitivities.blocks]
        return [start for start in starts if start.id == term.id]

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
