"""Laws fitted beside hypotheses, and what they are worth."""

from dataclasses import dataclass
from typing import Any, Mapping, Sequence, TypeVar

import numpy as np
from numpy import ndarray as Array
from scipy.stats import chi2

from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.form import Form, get_law
from rovsim.diagnosis.equations.products.columns import Columns, Wrenches, project
from rovsim.diagnosis.equations.products.library import push
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.structure.residual import FALSE_ALARM
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.observed_run import ObservedRun

Key = TypeVar("Key")


@dataclass(frozen=True, eq=False)
class LawFits:
    """Fits laws on top of hypotheses, about what was selected.

    `candidates`: so many terms there are to choose from, which sets the penalty of a number.
    """

    selection: SearchResult
    candidates: int

    @property
    def workspace(self) -> SearchWorkspace:
        """That of what was selected."""
        return self.selection.workspace

    @property
    def runs(self) -> tuple[ObservedRun, ...]:
        """What laws are fitted to."""
        return tuple(self.workspace.bank.runs)

    @property
    def penalty(self) -> float:
        """What a number of a law costs."""
        return 2.0 * float(np.log(self.candidates))

    @property
    def chance(self) -> float:
        """What the best of all terms explains by chance, with its penalty (Bonferroni's bound)."""
        return max(0.0, float(chi2.isf(FALSE_ALARM / self.candidates, 1)) - self.penalty)

    def fit_unless_worse(
        self, form: Form, h: Hypothesis, current: Fit, score: float
    ) -> FittedLaw | None:
        """A law, fitted with all else; None as soon as it surely does not come near a score.

        `current`: a fit whose derivatives it may begin with.
        """
        start = form.follow(h)
        fitted = self.selection.fit_unless_worse(start, current, score + self._extra_penalty(start))
        return None if fitted is None else self._score_law(form, fitted)

    def fit_each(
        self, laws: Mapping[Key, tuple[Form, Hypothesis]], current: Fit, score: float = -np.inf
    ) -> dict[Key, FittedLaw]:
        """Laws beside what is there, likeliest first; none far behind the others, or a score."""
        fitted: dict[Key, FittedLaw] = {}
        for key, (form, h) in laws.items():
            best = max((score, *(one.score for one in fitted.values())))
            judged = self.fit_unless_worse(form, h, current, best)
            fitted |= {key: judged} if judged else {}
        return dict(sorted(fitted.items(), key=lambda one: -one[1].score))

    def _score_law(self, form: Form, fitted: Fit) -> FittedLaw:
        score = self.workspace.score(fitted) - self._extra_penalty(fitted.hypothesis)
        return FittedLaw(form, fitted, score)

    def _extra_penalty(self, h: Hypothesis) -> float:
        """What the numbers of a law cost more than those of the catalogue."""
        return (self.penalty - self.workspace.penalty) * get_law(h).choices

    def is_worth(self, more: FittedLaw, less: Fit, score: float) -> bool:
        """Whether it explains more than chance, and users would see it in some axis' windows."""
        if more.score - score < self.chance:
            return False
        return bool(self.workspace.find_relevant(more.fit, [less.hypothesis.model])[0])

    def find_likeliest(
        self, laws: Mapping[Key, tuple[Form, Hypothesis]], beside: Fit
    ) -> FittedLaw | None:
        """The likeliest of laws to which nothing is added, if it is worth anything.

        None either where all stay far behind what was selected: such a law never takes its place.
        """
        selected = self.workspace.score(self.selection.best)
        best, *others = self.fit_each(laws, beside, selected).values() or (None,)
        if best is None or not self.is_worth(best, beside, self.workspace.score(beside)):
            return None
        return best.beats(others)

    def project(
        self, fit: Fit, candidates: Sequence[Any], middle: Array, wrenches: Wrenches = push
    ) -> Columns:
        """All candidate terms against what a fit leaves; see `columns.project`."""
        return project(candidates, fit, self.workspace.bank, middle, wrenches)
