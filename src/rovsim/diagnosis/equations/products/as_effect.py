"""A law of products as an effect of a hypothesis: its parameters, and which of them are free.

The effect is `Law`, whose parameters state the terms: for each a free coefficient, a fixed size,
and codes (`laws.codes`) of what the term acts on and of its factors. The coefficient is that of the
equation times the RMS of the term, so that it is of the order of the force.
"""

from dataclasses import dataclass, replace
from typing import Mapping, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Site
from rovsim.diagnosis.equations.form import get_law, split_law
from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import LawTerm, drag_of
from rovsim.dynamics.laws.codes import DEPTH, EAST, NEARNESS, NORTH, SWIRL
from rovsim.dynamics.laws.law import COEFFICIENTS, Law, Product
from rovsim.estimation.observer.hypothesis import Bounds, Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun

PLACE_MARGIN_M = 0.5  # m outside of where the vehicle was: a centre may lie a little apart


@dataclass(frozen=True, eq=False)
class CoveredRegion:
    """The region that the runs covered.

    Attributes:
        reach: least and greatest position (2, 3) of the vehicle in NED, m.
        site: of the runs, which says how MoCap axes point in NED.
    """

    reach: Array
    site: Site

    @staticmethod
    def of(runs: Sequence[ObservedRun]) -> "CoveredRegion":
        """Find the region that runs covered; the site is that of the first."""
        path = np.concatenate([run.motion.state[run.motion.usable, :3] for run in runs])
        reach = np.array([path.min(axis=0), path.max(axis=0)])
        return CoveredRegion(reach, runs[0].motion.site)

    @property
    def bounds(self) -> dict[str, Bounds]:
        """Range of each coordinate of a law's place, by name, in MoCap coordinates, m."""
        edges = np.sort(self.reach * self.site.axes, axis=0)
        return {
            n: Bounds(float(low - PLACE_MARGIN_M), float(high + PLACE_MARGIN_M))
            for n, low, high in zip("xyz", *edges, strict=True)
        }


def effect_of(law: Term) -> Law:
    """The effect that a law of products is."""
    assert isinstance(law.effect, Law)
    return law.effect


def place_of(law: Term, site: Site) -> Array:
    """Place (3,) in NED and width of a law, m, as one array (4,)."""
    return np.append(
        [law.effect[n] * s for n, s in zip("xyz", site.axes, strict=True)], law.effect["width"]
    )


def add_term(
    h: Hypothesis,
    law_terms: Sequence[LawTerm],
    more: LawTerm,
    columns: Columns,
    around: CoveredRegion,
) -> Hypothesis:
    """Add a term to the law of a hypothesis, with the coefficient that the regression gives.

    Args:
        h: a hypothesis, with a law of `law_terms`; without a law where there are none.
        law_terms: those of its law.
        more: the term to add, one of those of `columns`.
        columns: of candidate terms on top of the fit of `h`.
        around: the region that the runs covered, in which the law's place is bounded.

    Returns:
        The hypothesis with all coefficients of the law free, and the place and width where a term
        depends on them. A place or width that the law did not need before begins at that of the
        term, or else at the `middle` of the columns.
    """
    without_law, law = split_law(h)
    before = effect_of(law) if law else Law()
    terms, values = (*law_terms, more), before.others
    i = columns.terms.index(more)
    power = columns.gram[1 + i, 1 + i]
    coefficient = columns.gram[0, 1 + i] / power if power > 0.0 else 0.0
    size = 1.0 / columns.size[i]
    added = Product(float(coefficient), float(size), more.on, more.factors)
    place = columns.middle.copy()
    if more.place is not None:
        place[:2] = more.place
    bounds = around.bounds
    free_places = list_moved(terms)
    old = list_moved(law_terms)
    for n, p, sign in zip("xyz", place, around.site.axes, strict=False):
        if n in free_places and n not in old:
            values[n] = float(np.clip(p * sign, *bounds[n]))
    if "width" in free_places and "width" not in old:
        values["width"] = float(place[3])
    return _with_law(without_law, Law.of((*before.terms, added), **values), free_places, bounds)


def follow_drag(h: Hypothesis) -> Hypothesis:
    """Give the law the drag coefficients of the model beside it.

    Moving water acts on the vehicle through its drag. When another effect changes that drag, the
    law has to follow.
    """
    without_law, law = split_law(h)[0], get_law(h)
    linear, quadratic = drag_of(without_law.model)
    values = {f"linear{i}": float(v) for i, v in enumerate(linear)}
    values |= {f"quadratic{i}": float(v) for i, v in enumerate(quadratic)}
    updated = replace(law, effect=law.effect.with_values(values))
    return replace(without_law, terms=(*without_law.terms, updated))


def drop_term(h: Hypothesis, terms: Sequence[LawTerm], gone: int) -> Hypothesis:
    """Remove a term from the law of a hypothesis.

    Args:
        h: a hypothesis with a law.
        terms: of that law.
        gone: index of the term that is removed.
    """
    without_law, law = split_law(h)[0], get_law(h)
    before = effect_of(law)
    fewer = Law.of((*before.terms[:gone], *before.terms[gone + 1 :]), **before.others)
    moved = list_moved((*terms[:gone], *terms[gone + 1 :]))
    return _with_law(without_law, fewer, moved, law.bounds)


def _with_law(
    h: Hypothesis, law: Law, moved: Sequence[str], bounds: Mapping[str, Bounds]
) -> Hypothesis:
    """Add a law, of which all coefficients are free, and the coordinates that are `moved`."""
    free = (*COEFFICIENTS[: len(law.terms)], *moved)
    term = Term(law, free, {n: b for n, b in bounds.items() if n in moved})
    return replace(h, terms=(*h.terms, term))


def list_moved(terms: Sequence[LawTerm]) -> tuple[str, ...]:
    """List the names of the coordinates of a place, and its width, that some term depends on."""
    factors = {f for t in terms for f in t.factors}
    flat = bool(factors & {NEARNESS}) or any(t.on == SWIRL for t in terms)
    return (
        *(("x",) if flat or NORTH in factors else ()),
        *(("y",) if flat or EAST in factors else ()),
        *(("z",) if DEPTH in factors else ()),
        *(("width",) if NEARNESS in factors else ()),
    )
