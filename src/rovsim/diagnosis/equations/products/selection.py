"""Terms of a law, selected one after the other."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.law_fits import LawFits
from rovsim.diagnosis.equations.products.as_effect import (
    Surroundings,
    add_term,
    list_moved,
    place_of,
)
from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import (
    Known,
    LawTerm,
    list_terms,
    middle_of,
)
from rovsim.diagnosis.equations.products.products import Products
from rovsim.diagnosis.equations.products.search import propose
from rovsim.dynamics.effects.law import TERMS
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis

TRIED = 5  # terms that are fitted before one is added


def select_terms(fits: LawFits, start: Hypothesis) -> FittedLaw | None:
    """Forward selection of one to three terms, each refitted with all else before the next."""
    site, middle = fits.runs[0].motion.site, middle_of(fits.runs)
    terms: tuple[LawTerm, ...] = ()
    fit, best = fits.selection.fit(start), None
    score = fits.workspace.score(fit)
    while len(terms) < TERMS and fit.is_finite:
        known: Known = (None, None)
        if best is not None:
            middle, known = stay(middle, list_moved(terms), place_of(best.law, site))
        taken = [t.kind for t in terms]
        left = [t for t in list_terms(fits.runs, known) if t.kind not in taken]
        columns = fits.project(fit, left, middle)
        if len(columns.terms) < TERMS:
            break
        kinds = choose_kinds(propose(columns, TERMS - len(terms)))[:TRIED]
        tried = fit_products(fits, fit, terms, kinds, columns)
        more = next((k for k, one in tried.items() if fits.is_worth(one, fit, score)), None)
        if more is None:
            break
        best = tried.pop(more).beats(tried.values())
        terms, fit, score = (*terms, more), best.fit, best.score
    return best


def fit_products(
    fits: LawFits,
    fit: Fit,
    terms: tuple[LawTerm, ...],
    more: Sequence[LawTerm],
    columns: Columns,
) -> dict[LawTerm, FittedLaw]:
    """Laws of all these terms and one more beside a fit, the likeliest first.

    Args:
        fits: how.
        fit: with the law of the terms, if there are any.
        terms: what it has already.
        more: the terms that are tried.
        columns: of these, among others.
    """
    around = Surroundings.of(fits.runs)
    starts = {k: add_term(fit.hypothesis, terms, k, columns, around) for k in more}
    return fits.fit_each({k: (Products((*terms, k)), at) for k, at in starts.items()}, fit)


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
