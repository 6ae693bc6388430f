"""A law as an effect of a hypothesis: its terms as numbers, which of them are free, and how far."""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.run import Site
from rovsim.diagnosis.equations.form import get_law, split_law
from rovsim.diagnosis.equations.products.columns import Columns
from rovsim.diagnosis.equations.products.library import LawTerm, drag_of
from rovsim.dynamics.effects.law import FACTORS, Law
from rovsim.dynamics.effects.law_codes import DEEP, EAST, NEAR, NONE, NORTH, SWIRL
from rovsim.estimation.observer.hypothesis import Bounds, Hypothesis, Term
from rovsim.estimation.observer.observed_run import ObservedRun

MARGIN = 0.5  # m outside of where the vehicle was: a centre may lie a little apart


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Where the runs went: least and greatest place (2, 3) NED m, and the site."""

    reach: Array
    site: Site

    @staticmethod
    def of(runs: Sequence[ObservedRun]) -> "Surroundings":
        """Of some runs."""
        path = np.concatenate([run.motion.state[run.motion.usable, :3] for run in runs])
        reach = np.array([path.min(axis=0), path.max(axis=0)])
        return Surroundings(reach, runs[0].motion.site)

    @property
    def bounds(self) -> dict[str, Bounds]:
        """Where a centre may lie, in MoCap coordinates."""
        edges = np.sort(self.reach * self.site.axes, axis=0)
        return {
            n: Bounds(float(low - MARGIN), float(high + MARGIN))
            for n, low, high in zip("xyz", *edges, strict=True)
        }


def place_of(law: Term, site: Site) -> Array:
    """Place (3,) NED m and width m that a law's terms speak of."""
    return np.append(
        [law.effect[n] * s for n, s in zip("xyz", site.axes, strict=True)], law.effect["width"]
    )


def add_term(
    h: Hypothesis,
    known: Sequence[LawTerm],
    more: LawTerm,
    columns: Columns,
    around: Surroundings,
) -> Hypothesis:
    """The hypothesis with one more term in its law, at what the regression gives it.

    Args:
        h: some hypothesis, its law made of `known` terms.
        known: terms of its law.
        more: the term to add.
        columns: the terms, and their Gram matrix with what is left.
        around: where the runs went.
    """
    rest, law = split_law(h)
    terms = (*known, more)
    values = dict(law.effect.given()) if law else {}
    k, i = len(terms), columns.terms.index(more)
    power = columns.gram[1 + i, 1 + i]
    coefficient = columns.gram[0, 1 + i] / power if power > 0.0 else 0.0
    values |= {
        f"c{k}": float(coefficient),
        f"size{k}": float(1.0 / columns.size[i]),
        f"on{k}": float(more.on),
    }
    codes = (*more.factors, *[NONE] * (FACTORS - len(more.factors)))
    values |= {f"factor{k}{j}": float(code) for j, code in enumerate(codes, start=1)}
    place = columns.middle.copy()
    if more.place is not None:
        place[:2] = more.place
    bounds = around.bounds
    moved = list_moved(terms)
    old = list_moved(known)
    for n, p, sign in zip("xyz", place, around.site.axes, strict=False):
        if n in moved and n not in old:
            values[n] = float(np.clip(p * sign, *bounds[n]))
    if "width" in moved and "width" not in old:
        values["width"] = float(place[3])
    free = (*(f"c{j}" for j in range(1, k + 1)), *moved)
    own = Term(Law(**values), free, {n: bounds[n] for n in moved if n in bounds})
    return replace(rest, terms=(*rest.terms, own))


def follow_drag(h: Hypothesis) -> Hypothesis:
    """The hypothesis with the drag, which water that moves meets, of what the law stands beside."""
    rest, law = split_law(h)[0], get_law(h)
    linear, quadratic = drag_of(rest.model)
    values = {f"linear{i}": float(v) for i, v in enumerate(linear)}
    values |= {f"quadratic{i}": float(v) for i, v in enumerate(quadratic)}
    follows = replace(law, effect=law.effect.with_values(values))
    return replace(rest, terms=(*rest.terms, follows))


def drop_term(h: Hypothesis, terms: Sequence[LawTerm], gone: int) -> Hypothesis:
    """The hypothesis without one term of its law; the others move up."""
    rest, law = split_law(h)[0], get_law(h)
    kept = [k for k in range(len(terms)) if k != gone]
    own = ("c", "size", "on")
    values = {n: v for n, v in law.effect.given().items() if not n.startswith((*own, "factor"))}
    for new, old in enumerate(kept, start=1):
        values |= {f"{name}{new}": law.effect[f"{name}{old + 1}"] for name in own}
        for j in range(1, FACTORS + 1):
            values[f"factor{new}{j}"] = law.effect[f"factor{old + 1}{j}"]
    moved = list_moved([terms[k] for k in kept])
    free = (*(f"c{j}" for j in range(1, len(kept) + 1)), *moved)
    bounds = {n: b for n, b in law.bounds.items() if n in moved}
    return replace(rest, terms=(*rest.terms, Term(Law(**values), free, bounds)))


def list_moved(terms: Sequence[LawTerm]) -> tuple[str, ...]:
    """Which numbers of a law's place its terms depend on."""
    used = {f for t in terms for f in t.factors}
    flat = bool(used & {NEAR}) or any(t.on == SWIRL for t in terms)
    return (
        *(("x",) if flat or NORTH in used else ()),
        *(("y",) if flat or EAST in used else ()),
        *(("z",) if DEEP in used else ()),
        *(("width",) if NEAR in used else ()),
    )
