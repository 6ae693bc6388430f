"""Select the terms of a law one after the other, each refitted with all else."""

from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.equations.fitted_law import FittedLaw
from rovsim.diagnosis.equations.law_fits import LawFits
from rovsim.diagnosis.equations.products.as_effect import (
    CoveredRegion,
    add_term,
    list_moved,
    place_of,
)
from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import (
    KnownPlace,
    LawTerm,
    list_terms,
    middle_of,
)
from rovsim.diagnosis.equations.products.products import Products
from rovsim.diagnosis.equations.products.search import propose
from rovsim.dynamics.laws.law import MAX_TERMS
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis

TERMS_TRIED = 5  # fitted before one is added


def select_terms(fits: LawFits, start: Hypothesis) -> FittedLaw | None:
    """Select up to three terms of a law of products, each refitted with all else before the next.

    Args:
        fits: how laws are fitted and judged.
        start: a hypothesis without a law, to which the terms are added.

    Returns:
        The law with its rivals; None where not even one term is worth adding, or where no law could
        be as likely as the accepted effects.
    """
    site, middle = fits.runs[0].motion.site, middle_of(fits.runs)
    terms: tuple[LawTerm, ...] = ()
    fit, law = fits.selection.fit(start), None
    score = fits.workspace.score(fit)
    while len(terms) < MAX_TERMS and fit.is_finite:
        fixed_place: KnownPlace = (None, None)
        if law is not None:
            middle, fixed_place = stay(middle, list_moved(terms), place_of(law.law, site))
        used_kinds = [t.kind for t in terms]
        remaining = [t for t in list_terms(fits.runs, fixed_place) if t.kind not in used_kinds]
        columns = fits.project(fit, remaining, middle)
        count = MAX_TERMS - len(terms)
        if len(columns.terms) < MAX_TERMS or not fits.may_compete(score, columns, count):
            break
        kinds = choose_kinds(propose(columns, count))[:TERMS_TRIED]
        laws = fit_products(fits, fit, terms, kinds, columns)
        kind = next(
            (k for k, candidate in laws.items() if fits.is_worth(candidate, fit, score)), None
        )
        if kind is None:
            break
        law = laws.pop(kind).beats(laws.values())
        terms, fit, score = (*terms, kind), law.fit, law.score
    return law


def fit_products(
    fits: LawFits,
    fit: Fit,
    terms: tuple[LawTerm, ...],
    more: Sequence[LawTerm],
    columns: Columns,
) -> dict[LawTerm, FittedLaw]:
    """Fit laws of the terms so far and one more, the likeliest first in what is returned.

    Args:
        fits: how laws are fitted and judged.
        fit: with the law of the terms so far, if there are any.
        terms: terms so far.
        more: further terms, each of which is tried.
        columns: of candidate terms on top of `fit`, which have to include those of `more`.

    Returns:
        The fitted laws by their additional terms, without those that stay far behind.
    """
    surroundings = CoveredRegion.of(fits.runs)
    starts = {k: add_term(fit.hypothesis, terms, k, columns, surroundings) for k in more}
    return fits.fit_each({k: (Products((*terms, k)), at) for k, at in starts.items()}, fit)


def stay(middle: Array, moved: Sequence[str], place: Array) -> tuple[Array, KnownPlace]:
    """Keep those coordinates of a place that the law has fitted.

    Args:
        middle: (4,) place in NED and width, m, for terms that have none of their own.
        moved: names of the coordinates that the law has fitted: `x`, `y`, `z`, `width`.
        place: (4,) place in NED and width of the law, m.

    Returns:
        The place (4,) with the coordinates of the law where it has fitted them, and of these what
        is known of north and east.
    """
    fixed = np.array([name in moved for name in ("x", "y", "z", "width")])
    n, e = (
        float(p) if is_fixed else None for p, is_fixed in zip(place[:2], fixed[:2], strict=True)
    )
    return np.where(fixed, place, middle), (n, e)


def choose_kinds(terms: Sequence[LawTerm]) -> list[LawTerm]:
    """Keep the first term of each kind, which is the most promising.

    Terms of a kind differ by place alone, and a fit moves a place to where the term acts.
    """
    kinds: dict[tuple, LawTerm] = {}
    for term in terms:
        kinds.setdefault(term.kind, term)
    return list(kinds.values())
