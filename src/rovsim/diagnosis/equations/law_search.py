"""From what is left to an equation, or to none."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Iterator, Mapping, Sequence, TypeVar

import numpy as np
from numpy import ndarray as Array
from scipy.stats import chi2

from rovsim import AXES
from rovsim.diagnosis.checks.residual import FALSE_ALARM
from rovsim.diagnosis.equations.action import find_action, is_half
from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.form import Form, get_law
from rovsim.diagnosis.equations.products.as_effect import (
    Surroundings,
    add_term,
    list_moved,
    place_of,
)
from rovsim.diagnosis.equations.products.library import (
    Columns,
    Known,
    LawTerm,
    Push,
    list_terms,
    middle_of,
    project,
    push,
)
from rovsim.diagnosis.equations.products.products import Products
from rovsim.diagnosis.equations.products.search import find_alone, propose
from rovsim.diagnosis.equations.with_memory import FORMS
from rovsim.diagnosis.equations.with_thrust import WithThrust, begin, list_thrust_terms, push_thrust
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.observed_run import number_blocks
from rovsim.diagnosis.selection.candidates import list_means
from rovsim.diagnosis.selection.fit import Fit
from rovsim.diagnosis.selection.forward_selection import find_relevant
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import HOPELESS_LR, SearchWorkspace
from rovsim.dynamics.effects.law import TERMS

TRIED = 5  # terms that are fitted before one is added
BLOCKS = 3  # parts of the runs, each of which is left out once by the regression
HALF_LAW_MARGIN = 2.0  # times what chance allows: no fit to all runs brings so much below it
THRUST_LAWS_TRIED = 4
NEAR = 0.5  # of what products explain: laws of the thrust that may reach so much are fitted

Key = TypeVar("Key")


@dataclass(frozen=True, eq=False)
class LawSearch:
    """Laws on top of hypotheses, about what was selected.

    `candidates`: so many terms there are to choose from, which sets the penalty of a number.
    """

    selection: SearchResult
    candidates: int

    @property
    def workspace(self) -> SearchWorkspace:
        """That of what was selected."""
        return self.selection.workspace

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
        return bool(find_relevant(self.workspace, more.fit, [less.hypothesis.model])[0])

    @cached_property
    def surroundings(self) -> Surroundings:
        """Where the runs were."""
        return Surroundings.of(self.workspace.bank.runs)

    def fit_products(
        self,
        fit: Fit,
        terms: tuple[LawTerm, ...],
        more: Sequence[LawTerm],
        columns: Columns,
        middle: Array,
    ) -> dict[LawTerm, FittedLaw]:
        """Laws of all these terms and one more beside a fit, the likeliest first.

        Args:
            fit: with the law of the terms, if there are any.
            terms: what it has already.
            more: the terms that are tried.
            columns: of these, among others.
            middle: see `library.push`.
        """
        h, around = fit.hypothesis, self.surroundings
        starts = {k: add_term(h, terms, k, columns, middle, around) for k in more}
        return self.fit_each({k: (Products((*terms, k)), at) for k, at in starts.items()}, fit)

    def select_terms(self, start: Hypothesis) -> FittedLaw | None:
        """Forward selection of one to three terms, each refitted with all else before the next."""
        runs = self.workspace.bank.runs
        site, middle = self.surroundings.site, middle_of(runs)
        terms: tuple[LawTerm, ...] = ()
        fit, best = self.selection.fit(start), None
        score = self.workspace.score(fit)
        while len(terms) < TERMS and fit.is_finite:
            known: Known = (None, None)
            if best is not None:
                middle, known = stay(middle, list_moved(terms), place_of(best.law, site))
            taken = [t.kind for t in terms]
            left = [t for t in list_terms(runs, known) if t.kind not in taken]
            columns = project_terms(self.workspace, fit, left, middle)
            if len(columns.terms) < TERMS:
                break
            kinds = choose_kinds(propose(columns, TERMS - len(terms)))[:TRIED]
            tried = self.fit_products(fit, terms, kinds, columns, middle)
            more = next((k for k, one in tried.items() if self.is_worth(one, fit, score)), None)
            if more is None:
                break
            best = tried.pop(more).beats(tried.values())
            terms, fit, score = (*terms, more), best.fit, best.score
        return best

    def fit_memory_laws(self, start: Hypothesis) -> Iterator[FittedLaw | None]:
        """Of each form with a memory the likeliest, if it is worth anything."""
        runs = self.workspace.bank.runs
        axes = np.logical_and.reduce([run.axes for run in runs])
        moving = [AXES[i] for i in np.flatnonzero(axes)]
        means = list_means(runs, start.base.vehicle)
        for kind in (k for k in FORMS if k.effect.requires in means):
            beside = tuple(term for term in start.terms if term.id not in kind.imitates)
            bare = self.selection.fit(replace(start, terms=beside))
            if not bare.is_finite:
                continue
            laws = [(form, bare.hypothesis.with_term(law)) for form, law in kind.begin(moving)]
            yield self._find_likeliest(dict(enumerate(laws)), bare)

    def _find_likeliest(
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

    def keep_close(self, grown: Sequence[FittedLaw]) -> list[FittedLaw]:
        """Laws that may be the likeliest once they are finished."""
        most = max((one.score for one in grown), default=0.0)
        return [one for one in grown if one.score > most - HOPELESS_LR]

    def is_surely_half(self, grown: FittedLaw) -> bool:
        """Whether a law leaves so much on its own axis that it cannot hold."""
        bank = self.workspace.bank
        action = find_action(grown.form, grown.fit, bank.runs)
        return is_half(action.axis, grown.fit, bank, HALF_LAW_MARGIN)

    def fit_thrust_law(self, start: Hypothesis, grown: FittedLaw | None) -> FittedLaw | None:
        """The likeliest law of the thrust, where it may come near to what products explain."""
        fit = self.selection.fit(start)
        runs, score = self.workspace.bank.runs, self.workspace.score(fit)
        terms = list_thrust_terms(runs, fit.hypothesis.model)
        if not terms or not fit.is_finite:
            return None
        columns = project_terms(self.workspace, fit, terms, middle_of(runs), push_thrust)
        explained = find_alone(columns.products) - self.penalty
        least = max(self.chance, 0.0 if grown is None else NEAR * (grown.score - score))
        order = np.argsort(-explained, kind="stable")[:THRUST_LAWS_TRIED]
        laws = {
            int(k): (WithThrust(columns.terms[k]), begin(columns, int(k), fit.hypothesis))
            for k in order
            if explained[k] > least
        }
        return self._find_likeliest(laws, fit)

    def finish(self, grown: FittedLaw) -> FittedLaw:
        """Without effects of the catalogue that the law has made idle, and terms it can spare."""
        current = grown
        while True:
            h, form = current.fit.hypothesis, current.form
            fewer = [(form, h.without(i)) for i in self._list_idle(current.fit)]
            less = (*fewer, *form.simplify(h))
            tried = [self.fit_unless_worse(*one, current.fit, current.score) for one in less]
            best = max(filter(None, tried), key=lambda one: one.score, default=None)
            if best is None or best.score < current.score:
                return current
            # rivals of a term that went are rivals of nothing
            current = replace(best, rivals=current.rivals if best.form is form else ())

    def _list_idle(self, fit: Fit) -> list[int]:
        """Effects of the catalogue that to first order are not needed: others surely stay."""
        h, idle = fit.hypothesis, []
        for i, (term, own) in enumerate(zip(h.terms, h.columns, strict=True)):
            most = HOPELESS_LR + 2.0 * self.workspace.penalty * len(own)
            stays = own and term.vanishes and fit.distance(own) > most
            if term.effect.listed and not stays:
                idle.append(i)
        return idle


def stay(middle: Array, moved: Sequence[str], place: Array) -> tuple[Array, Known]:
    """A place (4,), where it is known the law's own, and what of it is known north and east."""
    own = np.array([name in moved for name in ("x", "y", "z", "width")])
    n, e = (float(p) if known else None for p, known in zip(place[:2], own[:2], strict=True))
    return np.where(own, place, middle), (n, e)


def choose_kinds(terms: Sequence[LawTerm]) -> list[LawTerm]:
    """The first of each kind: a fit moves it from where it begins to where it acts."""
    kinds: dict[tuple, LawTerm] = {}
    for term in terms:
        kinds.setdefault(term.kind, term)
    return list(kinds.values())


def search_laws(selection: SearchResult) -> FittedLaw | None:
    """The likeliest law beside what was selected, or in place of it; None where all may be chance.

    None either where an axis in which the vehicle can move is read now and then, or never: filters
    have another clock there.
    """
    runs, fit = selection.workspace.bank.runs, selection.best
    terms = list_terms(runs)
    if not terms or not is_seen(selection):
        return None
    thrusts = list_thrust_terms(runs, fit.hypothesis.model)
    search = LawSearch(selection, len(terms) + len(thrusts))
    starts = [fit.hypothesis]
    if fit.hypothesis.terms:
        starts.append(replace(fit.hypothesis, terms=()))
    each = [(start, search.select_terms(start)) for start in starts]
    laws = [own for _, own in each] + [search.fit_thrust_law(*one) for one in each]
    laws += [law for start in starts for law in search.fit_memory_laws(start)]
    grown = [law for law in laws if law is not None]
    if all(search.is_surely_half(one) for one in search.keep_close(grown)):
        return None  # which effects it can spare need not be known
    finished = sorted((search.finish(one) for one in grown), key=lambda one: -one.score)
    if not finished or finished[0].score <= selection.workspace.score(fit):
        return None
    return finished[0].beats(finished[1:])


def is_seen(selection: SearchResult) -> bool:
    """Whether each axis in which the vehicle can move is read at every reading."""
    runs = selection.workspace.bank.runs
    return all((run.innovation_mask | ~run.free_axes.astype(bool)).all() for run in runs)


def project_terms(
    workspace: SearchWorkspace,
    current: Fit,
    candidates: Sequence[Any],
    middle: Array,
    push: Push = push,
) -> Columns:
    """All candidate terms against what a fit leaves."""
    bank, noise = workspace.bank, current.noise
    white, J = bank.whiten(current.seen.e, noise), bank.whiten(current.seen.J, noise)
    return project(
        candidates,
        current.hypothesis.model,
        bank,
        white,
        J,
        bank.design_filters(noise),
        number_blocks(bank.runs) % BLOCKS,
        middle,
        push,
    )
