"""From what is left to an equation, or to none."""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.stats import chi2

from rovsim.diagnosis.equations.as_effect import (
    Surroundings,
    add_term,
    drop_term,
    list_moved,
    place_of,
    split_law,
)
from rovsim.diagnosis.equations.library import Columns, LawTerm, list_terms, middle_of, project
from rovsim.diagnosis.equations.search import propose
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.observed_run import number_blocks
from rovsim.diagnosis.selection.forward_selection import find_relevant
from rovsim.diagnosis.selection.gauss_newton import Fit
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.law import TERMS, Law

TRIED = 5  # terms that are fitted before one is added
BLOCKS = 3  # parts of the runs, each of which is left out once by the regression
FALSE_ALARM = 0.002  # of all terms together, as of every kind of structure


@dataclass(frozen=True, eq=False)
class Judged:
    """A law on top of a hypothesis, fitted; `score` with the `price` of each of its numbers paid.

    `rivals`: the same law with another last term.
    """

    terms: tuple[LawTerm, ...]
    fit: Fit
    score: float
    price: float
    rivals: tuple["Judged", ...] = ()

    @property
    def law(self) -> Term:
        """The law with its fitted values."""
        found = split_law(self.fit.hypothesis)[1]
        assert found is not None
        return found


def seek_law(workspace: SearchWorkspace, found: Fit) -> Judged | None:
    """The likeliest law beside what was found, or in place of it; None where all may be chance.

    None either where axes are read now and then: their filters have another clock.
    """
    if not all((run.shown | ~run.free.astype(bool)).all() for run in workspace.bank.runs):
        return None
    starts = [found.hypothesis]
    if found.hypothesis.terms:
        starts.append(replace(found.hypothesis, terms=()))
    grown = [one for start in starts if (one := _grow(workspace, start)) is not None]
    finished = [_finish(workspace, one) for one in grown]
    limit = workspace.score(found)
    return max(
        (one for one in finished if one.score > limit), key=lambda one: one.score, default=None
    )


def _grow(workspace: SearchWorkspace, start: Hypothesis) -> Judged | None:
    """A law of one to three terms, each refitted with all else before the next is added."""
    runs = workspace.bank.runs
    around, middle, place = Surroundings.of(runs), middle_of(runs), None
    candidates = list_terms(runs)
    if not candidates:
        return None
    price = 2.0 * float(np.log(len(candidates)))
    # what the best of all terms gains by chance, its price paid (Bonferroni's bound)
    chance = max(0.0, float(chi2.isf(FALSE_ALARM / len(candidates), 1)) - price)
    bare = workspace.fit(start)
    current = Judged((), bare, workspace.score(bare), price)
    while len(current.terms) < TERMS and np.isfinite(current.fit.likelihood):
        if list_moved(current.terms):
            middle = place_of(current.law, around.site)
            place = float(middle[0]), float(middle[1])
        left = [t for t in list_terms(runs, place) if t not in current.terms]
        columns = weigh(workspace, current.fit, left, middle)
        if len(columns.terms) < TERMS:
            break
        tried = []
        for term in propose(columns, TERMS - len(current.terms))[:TRIED]:
            h = add_term(
                current.fit.hypothesis, current.terms, term, columns, middle, around, start.model
            )
            tried.append(_score(workspace, (*current.terms, term), workspace.fit(h), price))
        best = max(tried, key=lambda one: one.score)
        rivals = tuple(one for one in tried if one is not best)
        if best.score - current.score < chance or not _is_noticed(workspace, best, current):
            break
        current = replace(best, rivals=rivals)
    return current if current.terms else None


def _is_noticed(workspace: SearchWorkspace, more: Judged, less: Judged) -> bool:
    """Whether users would see the difference in some axis' windows."""
    return bool(find_relevant(workspace, more.fit, [less.fit.hypothesis.model])[0])


def _finish(workspace: SearchWorkspace, grown: Judged) -> Judged:
    """Without effects of the catalogue that the law has made idle, and with what it uncovers."""
    current = grown
    while True:
        fewer = [_rescored(workspace, current, h) for h in _without_each(current.fit.hypothesis)]
        fewer += _with_fewer_terms(workspace, current)
        best = max(fewer, key=lambda one: one.score, default=None)
        if best is None or best.score < current.score:
            return current
        current = best


def _with_fewer_terms(workspace: SearchWorkspace, known: Judged) -> list[Judged]:
    if len(known.terms) == 1:
        return []
    found = []
    for k in range(len(known.terms)):
        fitted = workspace.fit(drop_term(known.fit.hypothesis, known.terms, k))
        left = tuple(t for i, t in enumerate(known.terms) if i != k)
        found.append(replace(_score(workspace, left, fitted, known.price), rivals=known.rivals))
    return found


def _without_each(h: Hypothesis) -> list[Hypothesis]:
    return [h.without(i) for i, term in enumerate(h.terms) if term.id != Law.id]


def _rescored(workspace: SearchWorkspace, known: Judged, h: Hypothesis) -> Judged:
    again = _score(workspace, known.terms, workspace.fit(h), known.price)
    return replace(again, rivals=known.rivals)


def _score(
    workspace: SearchWorkspace, terms: tuple[LawTerm, ...], fitted: Fit, price: float
) -> Judged:
    law = split_law(fitted.hypothesis)[1]
    assert law is not None
    score = workspace.score(fitted) - (price - workspace.price) * law.choices
    return Judged(terms, fitted, score, price)


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
