"""Fit laws beside the effects of a hypothesis, and judge what they are worth."""

from dataclasses import dataclass
from typing import Any, Mapping, Sequence, TypeVar

import numpy as np
from numpy import ndarray as Array
from scipy.stats import chi2

from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.form import Form, get_law
from rovsim.diagnosis.equations.products.columns import Columns, Wrenches, project
from rovsim.diagnosis.equations.products.library import evaluate_wrenches
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import HOPELESS_LR, SearchWorkspace
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.least_squares import regress_forward
from rovsim.estimation.observer.observed_run import ObservedRun

# Times what first order promises: more is not gained. Of 22 laws none gained more than 5.4 times.
MAX_GAIN_FACTOR = 10.0
Key = TypeVar("Key")


@dataclass(frozen=True, eq=False)
class LawFits:
    """Fits laws beside the effects of hypotheses.

    Attributes:
        selection: where the search ended; its runs, filters and noise are used.
        candidates: number of terms to choose from, which sets the penalty of a law's parameter.
    """

    selection: SearchResult
    candidates: int

    @property
    def workspace(self) -> SearchWorkspace:
        """The workspace of the search."""
        return self.selection.workspace

    @property
    def runs(self) -> tuple[ObservedRun, ...]:
        """The runs that laws are fitted to."""
        return tuple(self.workspace.bank.runs)

    @property
    def penalty(self) -> float:
        """Penalty of a free parameter of a law, as a likelihood-ratio statistic."""
        return 2.0 * float(np.log(self.candidates))

    @property
    def chance(self) -> float:
        """What the best of all terms gains by chance, less its penalty (Bonferroni's bound)."""
        return max(0.0, float(chi2.isf(FALSE_ALARM_RATE / self.candidates, 1)) - self.penalty)

    def fit_unless_below(
        self, form: Form, h: Hypothesis, current: Fit, least: float
    ) -> FittedLaw | None:
        """Fit a law and all else; None as soon as its score will surely not reach `least`.

        Args:
            form: of the law.
            h: a hypothesis with the law.
            current: a fit whose derivatives are taken at first.
            least: score to be reached.
        """
        start = form.follow(h)
        fit = self.selection.fit_unless_below(start, current, least + self._extra_penalty(start))
        return None if fit is None else self.score_law(form, fit)

    def fit_each(
        self, laws: Mapping[Key, tuple[Form, Hypothesis]], current: Fit, score: float = -np.inf
    ) -> dict[Key, FittedLaw]:
        """Fit several laws, the likeliest first in what is returned.

        Laws that stay far behind the others, or far below `score`, are left out.
        """
        fits: dict[Key, FittedLaw] = {}
        for key, (form, h) in laws.items():
            best_score = max((score, *(x.score for x in fits.values())))
            law = self.fit_unless_below(form, h, current, best_score - HOPELESS_LR)
            fits |= {key: law} if law else {}
        return dict(sorted(fits.items(), key=lambda x: -x[1].score))

    def score_law(self, form: Form, fitted: Fit) -> FittedLaw:
        """A fit of a hypothesis with a law, and its score."""
        score = self.workspace.score(fitted) - self._extra_penalty(fitted.hypothesis)
        return FittedLaw(form, fitted, score)

    def _extra_penalty(self, h: Hypothesis) -> float:
        """By how much the penalty of a law exceeds that of an effect with as many parameters."""
        return (self.penalty - self.workspace.penalty) * get_law(h).choices

    def is_worth(self, more: FittedLaw, less: Fit, score: float) -> bool:
        """Whether a law explains more than chance, and replays without it are clearly worse.

        Args:
            more: with the law.
            less: without the law.
            score: of `less`.
        """
        if more.score - score < self.chance:
            return False
        return bool(self.workspace.find_relevant(more.fit, [less.hypothesis.model])[0])

    def may_compete(self, score: float, columns: Columns, count: int) -> bool:
        """Whether further terms may make a law as likely as the accepted effects.

        If terms explain a share of what is left of n readings of one axis, twice their log
        likelihood rises by about -n log(1 - share). What first order tells of that share is too
        little, since the filters take for a disturbance what a law would explain.

        Args:
            score: without these terms.
            columns: of the candidate terms.
            count: how many terms may be added.
        """
        G = columns.gram
        decrease = regress_forward(G[1:, 1:], G[1:, 0], count).ss_decrease
        readings = sum(int(run.settled.sum()) for run in self.runs)
        if decrease >= readings:
            return True
        gain = -MAX_GAIN_FACTOR * readings * np.log1p(-decrease / readings)
        return score + gain > self.workspace.score(self.selection.best) - HOPELESS_LR

    def find_likeliest(
        self, laws: Mapping[Key, tuple[Form, Hypothesis]], beside: Fit
    ) -> FittedLaw | None:
        """The likeliest of several complete laws, with the others as its rivals.

        None where it is not worth its penalty beside the fit `beside`, or where all laws stay far
        behind the accepted effects, so that none could take their place.
        """
        selected = self.workspace.score(self.selection.best)
        likeliest, *rivals = self.fit_each(laws, beside, selected).values() or (None,)
        if likeliest is None or not self.is_worth(likeliest, beside, self.workspace.score(beside)):
            return None
        return likeliest.beats(rivals)

    def project(
        self,
        fit: Fit,
        candidates: Sequence[Any],
        middle: Array,
        wrenches: Wrenches = evaluate_wrenches,
    ) -> Columns:
        """Columns of candidate terms and what a fit leaves; see `columns.project`."""
        return project(candidates, fit, self.workspace.bank, middle, wrenches)
