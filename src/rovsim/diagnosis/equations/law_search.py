"""From what is left to an equation, or to none."""

from dataclasses import replace
from typing import Iterator, Sequence

import numpy as np

from rovsim import AXES
from rovsim.diagnosis.equations.action import find_action, is_half
from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.law_fits import LawFits
from rovsim.diagnosis.equations.products.library import list_terms, middle_of
from rovsim.diagnosis.equations.products.search import find_alone
from rovsim.diagnosis.equations.products.selection import select_terms
from rovsim.diagnosis.equations.with_memory import FORMS
from rovsim.diagnosis.equations.with_thrust import WithThrust, begin, list_thrust_terms, push_thrust
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import HOPELESS_LR
from rovsim.estimation.candidates import list_means
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis

HALF_LAW_MARGIN = 2.0  # times what chance allows: no fit to all runs brings so much below it
THRUST_LAWS_TRIED = 4  # those that explain most to first order
NEAR = 0.5  # of what products explain: laws of the thrust that may reach so much are fitted


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
    fits = LawFits(selection, len(terms) + len(thrusts))
    starts = [fit.hypothesis]
    if fit.hypothesis.terms:
        starts.append(replace(fit.hypothesis, terms=()))
    each = [(start, select_terms(fits, start)) for start in starts]
    laws = [own for _, own in each] + [_fit_thrust_law(fits, *one) for one in each]
    laws += [law for start in starts for law in _fit_memory_laws(fits, start)]
    grown = [law for law in laws if law is not None]
    if all(_is_surely_half(fits, one) for one in _keep_close(grown)):
        return None  # which effects it can spare need not be known
    finished = sorted((_finish(fits, one) for one in grown), key=lambda one: -one.score)
    if not finished or finished[0].score <= selection.workspace.score(fit):
        return None
    return finished[0].beats(finished[1:])


def is_seen(selection: SearchResult) -> bool:
    """Whether each axis in which the vehicle can move is read at every reading."""
    runs = selection.workspace.bank.runs
    return all((run.innovation_mask | ~run.free_axes.astype(bool)).all() for run in runs)


def _fit_memory_laws(fits: LawFits, start: Hypothesis) -> Iterator[FittedLaw | None]:
    """Of each form with a memory the likeliest, if it is worth anything."""
    axes = np.logical_and.reduce([run.axes for run in fits.runs])
    moving = [AXES[i] for i in np.flatnonzero(axes)]
    means = list_means(fits.runs, start.base.vehicle)
    for kind in (k for k in FORMS if k.effect.requires in means):
        beside = tuple(term for term in start.terms if term.id not in kind.imitates)
        bare = fits.selection.fit(replace(start, terms=beside))
        if not bare.is_finite:
            continue
        laws = [(form, bare.hypothesis.with_term(law)) for form, law in kind.begin(moving)]
        yield fits.find_likeliest(dict(enumerate(laws)), bare)


def _fit_thrust_law(fits: LawFits, start: Hypothesis, grown: FittedLaw | None) -> FittedLaw | None:
    """The likeliest law of the thrust, where it may come near to what products explain."""
    fit = fits.selection.fit(start)
    score = fits.workspace.score(fit)
    terms = list_thrust_terms(fits.runs, fit.hypothesis.model)
    if not terms or not fit.is_finite:
        return None
    columns = fits.project(fit, terms, middle_of(fits.runs), push_thrust)
    explained = find_alone(columns.gram) - fits.penalty
    least = max(fits.chance, 0.0 if grown is None else NEAR * (grown.score - score))
    order = np.argsort(-explained, kind="stable")[:THRUST_LAWS_TRIED]
    laws = {
        int(k): (WithThrust(columns.terms[k]), begin(columns, int(k), fit.hypothesis))
        for k in order
        if explained[k] > least
    }
    return fits.find_likeliest(laws, fit)


def _keep_close(grown: Sequence[FittedLaw]) -> list[FittedLaw]:
    """Laws that may be the likeliest once they are finished."""
    most = max((one.score for one in grown), default=0.0)
    return [one for one in grown if one.score > most - HOPELESS_LR]


def _is_surely_half(fits: LawFits, grown: FittedLaw) -> bool:
    """Whether a law leaves so much on its own axis that it cannot hold."""
    action = find_action(grown.form, grown.fit, fits.runs)
    return is_half(action.axis, grown.fit, fits.workspace.bank, HALF_LAW_MARGIN)


def _finish(fits: LawFits, grown: FittedLaw) -> FittedLaw:
    """Without effects of the catalogue that the law has made idle, and terms it can spare."""
    current = grown
    while True:
        h, form = current.fit.hypothesis, current.form
        fewer = [(form, h.without(i)) for i in _list_idle(fits, current.fit)]
        less = (*fewer, *form.simplify(h))
        tried = [fits.fit_unless_worse(*one, current.fit, current.score) for one in less]
        best = max(filter(None, tried), key=lambda one: one.score, default=None)
        if best is None or best.score < current.score:
            return current
        # rivals of a term that went are rivals of nothing
        current = replace(best, rivals=current.rivals if best.form is form else ())


def _list_idle(fits: LawFits, fit: Fit) -> list[int]:
    """Effects of the catalogue that to first order are not needed: others surely stay."""
    h, idle = fit.hypothesis, []
    for i, (term, own) in enumerate(zip(h.terms, h.columns, strict=True)):
        most = HOPELESS_LR + 2.0 * fits.workspace.penalty * len(own)
        stays = own and term.vanishes and fit.distance(own) > most
        if term.effect.listed and not stays:
            idle.append(i)
    return idle
