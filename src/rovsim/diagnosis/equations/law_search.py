"""Search for the law that explains most of what the accepted effects leave."""

from dataclasses import replace
from functools import partial
from itertools import chain
from typing import Iterator, Sequence

import numpy as np

from rovsim.core.axes import AXES
from rovsim.core.threads import map_on_cores
from rovsim.diagnosis.equations.action import find_action
from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.law_fits import LawFits
from rovsim.diagnosis.equations.products.library import list_terms, middle_of
from rovsim.diagnosis.equations.products.selection import select_terms
from rovsim.diagnosis.equations.with_memory import FORMS, WithMemory
from rovsim.diagnosis.equations.with_thrust import (
    WithThrust,
    begin,
    evaluate_thrust,
    list_thrust_terms,
)
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.vehicle_file.steps import add_file_effects
from rovsim.diagnosis.selection.workspace import HOPELESS_LR
from rovsim.diagnosis.structure.residual_structure import find_structure
from rovsim.estimation.candidates import list_means
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis

HALF_LAW_MARGIN = 2.0  # times what chance allows: a fit to all runs does not change so much
THRUST_LAWS_TRIED = 4  # laws of the thrust that are fitted: those best to first order
# Of what products explain: a law of the thrust is not fitted if it may explain less.
MIN_SHARE_OF_PRODUCTS = 0.5


def search_laws(selection: SearchResult) -> FittedLaw | None:
    """Search for the likeliest law beside the accepted effects, or in their place.

    Returns:
        The law with its rivals. None where chance may explain all laws, where the accepted effects
        without a law are likelier, or where some axis in which the vehicle can move is not read at
        every reading, for its filter then runs at another rate.
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
    laws = map_on_cores(lambda start: select_terms(fits, start), starts)
    laws += map_on_cores(partial(_fit_thrust_law, fits), starts, laws)
    laws += chain(*map_on_cores(lambda start: list(fit_memory_laws(fits, start)), starts))
    grown = [law for law in laws if law is not None]
    if all(_is_surely_half(fits, candidate) for candidate in _keep_close(grown)):
        return None  # so nothing needs to be known of the effects that a law makes unnecessary
    finished = map_on_cores(partial(_finish, fits), grown)
    finished.sort(key=lambda candidate: -candidate.score)
    if not finished or finished[0].score <= selection.workspace.score(fit):
        return None
    return _add_rest_of_file(fits, finished[0].beats(finished[1:]))


def _add_rest_of_file(fits: LawFits, law: FittedLaw) -> FittedLaw:
    """With other numbers of a loose vehicle file, without the terms that stood in for them.

    Beside unknown physics few of these numbers were worth their penalty.
    """
    if not has_loose_file(law.fit.hypothesis):
        return law
    fit = add_file_effects(fits.workspace, law.fit)
    if fit is law.fit:
        return law
    return _finish(fits, replace(fits.score_law(law.form, fit), rivals=law.rivals))


def is_seen(selection: SearchResult) -> bool:
    """Whether each axis in which the vehicle can move is read at every reading."""
    runs = selection.workspace.bank.runs
    return all((run.innovation_mask | ~run.free_axes.astype(bool)).all() for run in runs)


def fit_memory_laws(
    fits: LawFits, start: Hypothesis, forms: Sequence[type[WithMemory]] = FORMS
) -> Iterator[FittedLaw | None]:
    """For each form with a memory the likeliest law; None for a form that explains too little."""
    axes = np.logical_and.reduce([run.axes for run in fits.runs])
    moving = [AXES[i] for i in np.flatnonzero(axes)]
    means = list_means(fits.runs, start.base.vehicle)
    for kind in (k for k in forms if k.effect.requires in means):
        beside = tuple(term for term in start.terms if term.id not in kind.imitates)
        without_law = fits.selection.fit(replace(start, terms=beside))
        if not without_law.is_finite:
            continue
        laws = [(form, without_law.hypothesis.with_term(law)) for form, law in kind.begin(moving)]
        acting = (x for x in laws if _changes_anything(fits, *x, without_law))
        yield fits.find_likeliest(dict(enumerate(acting)), without_law)


def _changes_anything(fits: LawFits, form: WithMemory, h: Hypothesis, without_law: Fit) -> bool:
    """Whether a law changes any innovation: none of thrusters does where loops drive all axes."""
    e = fits.workspace.bank.innovations(form.follow(h).model)
    return not all(map(np.array_equal, e, without_law.linearised.e))


def _fit_thrust_law(fits: LawFits, start: Hypothesis, grown: FittedLaw | None) -> FittedLaw | None:
    """The likeliest law of the thrust; None where products of states explain far more."""
    fit = fits.selection.fit(start)
    score = fits.workspace.score(fit)
    terms = list_thrust_terms(fits.runs, fit.hypothesis.model)
    if not terms or not fit.is_finite:
        return None
    columns = fits.project(fit, terms, middle_of(fits.runs), evaluate_thrust)
    explained = columns.decreases - fits.penalty
    threshold = max(
        fits.chance, 0.0 if grown is None else MIN_SHARE_OF_PRODUCTS * (grown.score - score)
    )
    order = np.argsort(-explained, kind="stable")[:THRUST_LAWS_TRIED]
    laws = {
        int(k): (WithThrust(columns.terms[k]), begin(columns, int(k), fit.hypothesis))
        for k in order
        if explained[k] > threshold
    }
    return fits.find_likeliest(laws, fit)


def _keep_close(grown: Sequence[FittedLaw]) -> list[FittedLaw]:
    """Laws that may be the likeliest once they are simplified."""
    best_score = max((law.score for law in grown), default=0.0)
    return [law for law in grown if law.score > best_score - HOPELESS_LR]


def _is_surely_half(fits: LawFits, grown: FittedLaw) -> bool:
    """Whether a law leaves so much structure on its own axis that it cannot be complete."""
    structures = find_structure(grown.fit, fits.workspace.bank)
    return find_action(grown.form, grown.fit, fits.runs).leaves_structure(
        structures, HALF_LAW_MARGIN
    )


def _finish(fits: LawFits, grown: FittedLaw) -> FittedLaw:
    """Remove effects that the law has made unnecessary, and terms that it does not need."""
    current = grown
    while True:
        h, form = current.fit.hypothesis, current.form
        without_term = [(form, h.without(i)) for i in _list_idle(fits, current.fit)]
        shorter = (*without_term, *form.simplify(h))
        laws = [fits.fit_unless_below(*x, current.fit, current.score) for x in shorter]
        best_law = max(filter(None, laws), key=lambda x: x.score, default=None)
        if best_law is None or best_law.score < current.score:
            return current
        # a law with a term less has no rivals yet: those of the longer law competed with that term
        current = replace(best_law, rivals=current.rivals if best_law.form is form else ())


def _list_idle(fits: LawFits, fit: Fit) -> list[int]:
    """Effects of the catalogue (by number) that may be unnecessary, judged to first order."""
    h, idle = fit.hypothesis, []
    for i, (term, columns) in enumerate(zip(h.terms, h.columns, strict=True)):
        threshold = HOPELESS_LR + 2.0 * fits.workspace.penalty * len(columns)
        significant = columns and term.vanishes and fit.wald_statistic(columns) > threshold
        if term.effect.listed and not significant:
            idle.append(i)
    return idle
