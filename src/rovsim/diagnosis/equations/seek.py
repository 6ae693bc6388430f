"""From what is left to an equation, or to none."""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.stats import chi2

from rovsim import AXES
from rovsim.diagnosis.equations.form import Form, get_law
from rovsim.diagnosis.equations.products.as_effect import (
    Surroundings,
    add_term,
    list_moved,
    place_of,
)
from rovsim.diagnosis.equations.products.library import (
    Columns,
    LawTerm,
    list_terms,
    middle_of,
    project,
)
from rovsim.diagnosis.equations.products.products import Products
from rovsim.diagnosis.equations.products.search import propose
from rovsim.diagnosis.equations.with_memory import FORMS
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.observed_run import number_blocks
from rovsim.diagnosis.selection.candidates import list_means
from rovsim.diagnosis.selection.forward_selection import find_relevant
from rovsim.diagnosis.selection.gauss_newton import Fit
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.law import TERMS

TRIED = 5  # terms that are fitted before one is added
BLOCKS = 3  # parts of the runs, each of which is left out once by the regression
FALSE_ALARM = 0.002  # of all terms together, as of every kind of structure


@dataclass(frozen=True, eq=False)
class Judged:
    """A law on top of a hypothesis, fitted; `score` with the price of each of its numbers paid.

    `rivals`: laws that were tried in its place.
    """

    form: Form
    fit: Fit
    score: float
    rivals: tuple["Judged", ...] = ()

    @property
    def law(self) -> Term:
        """The law with its fitted values."""
        return get_law(self.fit.hypothesis)


@dataclass(frozen=True, eq=False)
class LawSearch:
    """Laws on top of hypotheses, about what a workspace knows.

    `candidates`: so many terms there are to choose from, which sets the price of a number.
    """

    workspace: SearchWorkspace
    candidates: int

    @property
    def price(self) -> float:
        """What a number of a law costs, in twice the log likelihood."""
        return 2.0 * float(np.log(self.candidates))

    @property
    def chance(self) -> float:
        """What the best of all terms gains by chance, its price paid (Bonferroni's bound)."""
        return max(0.0, float(chi2.isf(FALSE_ALARM / self.candidates, 1)) - self.price)

    def judge(self, form: Form, h: Hypothesis) -> Judged:
        """A law, fitted with all else."""
        fitted = self.workspace.fit(h)
        more = (self.price - self.workspace.price) * get_law(fitted.hypothesis).choices
        return Judged(form, fitted, self.workspace.score(fitted) - more)

    def is_worth(self, more: Judged, less: Fit, score: float) -> bool:
        """Whether it gains more than chance would, and users would see it in some axis' windows."""
        if more.score - score < self.chance:
            return False
        return bool(find_relevant(self.workspace, more.fit, [less.hypothesis.model])[0])

    def grow(self, start: Hypothesis) -> Judged | None:
        """Products of one to three terms, each refitted with all else before the next is added."""
        runs = self.workspace.bank.runs
        around, middle, place = Surroundings.of(runs), middle_of(runs), None
        terms: tuple[LawTerm, ...] = ()
        fit, best = self.workspace.fit(start), None
        score = self.workspace.score(fit)
        while len(terms) < TERMS and np.isfinite(fit.likelihood):
            if best and list_moved(terms):
                middle = place_of(best.law, around.site)
                place = float(middle[0]), float(middle[1])
            left = [t for t in list_terms(runs, place) if t not in terms]
            columns = weigh(self.workspace, fit, left, middle)
            if len(columns.terms) < TERMS:
                break
            tried = {}
            for more in propose(columns, TERMS - len(terms))[:TRIED]:
                h = add_term(fit.hypothesis, terms, more, columns, middle, around, start.model)
                tried[more] = self.judge(Products((*terms, more)), h)
            more = max(tried, key=lambda one: tried[one].score)
            if not self.is_worth(tried[more], fit, score):
                break
            best = replace(tried.pop(more), rivals=tuple(tried.values()))
            terms, fit, score = (*terms, more), best.fit, best.score
        return best

    def remember(self, start: Hypothesis) -> list[Judged]:
        """Of each form with a memory the likeliest, if it is worth anything."""
        runs, found = self.workspace.bank.runs, []
        axes = np.logical_and.reduce([run.axes for run in runs])
        moving, means = (
            [AXES[i] for i in np.flatnonzero(axes)],
            list_means(runs, start.base.vehicle),
        )
        for kind in (k for k in FORMS if k.effect.through in means):
            beside = tuple(term for term in start.terms if term.id not in kind.imitates)
            bare = self.workspace.fit(replace(start, terms=beside))
            tried = [
                self.judge(form, replace(bare.hypothesis, terms=(*bare.hypothesis.terms, law)))
                for form, law in kind.begin(moving)
            ]
            best = max(tried, key=lambda one: one.score)
            if self.is_worth(best, bare, self.workspace.score(bare)):
                found.append(best)
        return found

    def finish(self, grown: Judged) -> Judged:
        """Without effects of the catalogue that the law has made idle, and terms it can spare."""
        current = grown
        while True:
            h = current.fit.hypothesis
            fewer = [(current.form, h.without(i)) for i, t in enumerate(h.terms) if t.effect.listed]
            tried = [self.judge(*one) for one in (*fewer, *current.form.simplify(h))]
            best = max(tried, key=lambda one: one.score, default=None)
            if best is None or best.score < current.score:
                return current
            current = replace(best, rivals=current.rivals)


def seek_law(workspace: SearchWorkspace, found: Fit) -> Judged | None:
    """The likeliest law beside what was found, or in place of it; None where all may be chance.

    None either where axes are read now and then: their filters have another clock.
    """
    runs = workspace.bank.runs
    if not all((run.shown | ~run.free.astype(bool)).all() for run in runs):
        return None
    search = LawSearch(workspace, len(list_terms(runs)))
    if not search.candidates:
        return None
    starts = [found.hypothesis]
    if found.hypothesis.terms:
        starts.append(replace(found.hypothesis, terms=()))
    grown = [one for start in starts if (one := search.grow(start)) is not None]
    grown += [one for start in starts for one in search.remember(start)]
    finished = sorted((search.finish(one) for one in grown), key=lambda one: -one.score)
    if not finished or finished[0].score <= workspace.score(found):
        return None
    best, *others = finished
    other = [one for one in others if one.form != best.form][:1]
    return replace(best, rivals=(*best.rivals, *other))


def weigh(
    workspace: SearchWorkspace, current: Fit, candidates: Sequence[LawTerm], middle: Array
) -> Columns:
    """All candidate terms against what a fit leaves."""
    bank, noise = workspace.bank, current.noise
    white, J = bank.whiten(current.seen.e, noise), bank.whiten(current.seen.J, noise)
    return project(
        candidates, current.hypothesis.model, bank, white, J, bank.tune(noise),
        number_blocks(bank.runs) % BLOCKS, middle,
    )  # fmt: skip
