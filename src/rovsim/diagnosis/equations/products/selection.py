"""Select the terms of a law one after the other, each refitted with all else."""

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
    """Select up to three terms of a law of products, each refitted with all else before the next.

    Args:
        fits: how laws are fitted and judged.
        start: a hypothesis without a law, to which the terms are added.

    Returns:
        The law with its rivals; None where not even one term is worth adding.
    """
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
    around = Surroundings.of(fits.runs)
    starts = {k: add_term(fit.hypothesis, terms, k, columns, around) for k in more}
    return fits.fit_each({k: (Products((*terms, k)), at) for k, at in starts.items()}, fit)


def stay(middle: Array, moved: Sequence[str], place: Array) -> tuple[Array, Known]:
    """Keep those coordinates of a place that the law has fitted.

    Args:
        middle: (4,) place in NED and width, m, for terms that have none of their own.
        moved: names of the coordinates that the law has fitted: `x`, `y`, `z`, `width`.
        place: (4,) place in NED and width of the law, m.

    Returns:
        The place (4,) with the coordinates of the law where it has fitted them, and of these what
        is known of north and east.
    """
    own = np.array([name in moved for name in ("x", "y", "z", "width")])
    n, e = (float(p) if known else None for p, known in zip(place[:2], own[:2], strict=True))
    return np.where(own, place, middle), (n, e)


def choose_kinds(terms: Sequence[LawTerm]) -> list[LawTerm]:
    """Keep the first term of each kind, which is the most promising.

    Terms of a kind differ by place alone, and a fit moves a place to where the term acts.
    """
    kinds: dict[tuple, LawTerm] = {}
    for term in terms:
        kinds.setdefault(term.kind, term)
    return list(kinds.values())
