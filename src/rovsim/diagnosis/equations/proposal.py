"""A law that holds: its values on all runs, what it is worth, and how it is written."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, Sequence

import numpy as np

from rovsim import AXES
from rovsim.core.extras import installed
from rovsim.diagnosis.checks.residual_structure import find_structure
from rovsim.diagnosis.equations.as_effect import split_law
from rovsim.diagnosis.equations.effect_file import (
    Number,
    describe,
    list_numbers,
    write_equation,
    write_file,
)
from rovsim.diagnosis.equations.library import LawTerm, middle_of, push
from rovsim.diagnosis.equations.seek import Judged, seek_law
from rovsim.diagnosis.equations.variables import ON, SWIRL, VARIABLES, WATER, WORLD
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.observer.windows import score_windows
from rovsim.diagnosis.selection.gate import Gate
from rovsim.diagnosis.selection.gauss_newton import Fit
from rovsim.diagnosis.selection.held_out import cross_validate
from rovsim.diagnosis.selection.rivals import Selection
from rovsim.dynamics.model import Model
from rovsim.results.base import or_nan

ID, FILE = "proposed_effect", "proposed_effect.py"
STORY = "Proposed by `rovsim diagnose` for what no effect of the catalogue explains."
ENOUGH = 0.05  # of the error of replays: less is not worth an equation

Polish = Callable[[Fit], tuple[Fit, FilterBank]]


@dataclass(frozen=True, eq=False)
class ProposedLaw:
    """A law of these terms, fitted with all else to all train runs.

    `error_reduction`: share of the base's error in 2 s windows that it removes on top of all else;
    `sizes` N or N m, RMS of each term; `axis` on which it acts most; `rivals`: equations with
    another last term, and by how much less likely each is.
    """

    terms: tuple[LawTerm, ...]
    fit: Fit
    error_reduction: float
    sizes: tuple[float, ...]
    axis: str
    rivals: tuple[tuple[str, float], ...]

    @property
    def law(self) -> Term:
        """The law, as the engine knows it."""
        found = split_law(self.fit.hypothesis)[1]
        assert found is not None
        return found

    @property
    def beside(self) -> list[tuple[int, Term]]:
        """Effects of the catalogue beside it, and their places in the hypothesis."""
        each = enumerate(self.fit.hypothesis.terms)
        return [(i, term) for i, term in each if term.id != self.law.id]

    @property
    def model(self) -> Model:
        """All that was found, with the law."""
        return self.fit.hypothesis.model.called(f"+{ID}")

    @cached_property
    def numbers(self) -> list[Number]:
        """Its parameters in the units of its equation."""
        h = self.fit.hypothesis
        own = h.columns[[t.id for t in h.terms].index(self.law.id)]
        scales = [p.scale for p in self.law.parameters]
        return list_numbers(self.terms, self.law, list(self.fit.std[own] * scales))

    @property
    def equation(self) -> str:
        """In LaTeX."""
        return write_equation(self.terms)

    @property
    def meaning(self) -> str:
        """In a sentence."""
        return describe(self.terms)

    @property
    def source(self) -> str:
        """The effect as a Python file."""
        return write_file(ID, self.terms, self.law, self.numbers, STORY)


def propose_law(
    selection: Selection, catalogued: Model, base: Model, gate: Gate,
    runs: Sequence[ObservedRun], polish: Polish,
) -> ProposedLaw | None:  # fmt: skip
    """An equation for what is left; None where none holds.

    A law holds if it gains more than the best of so many terms would by chance, if it helps on
    blocks it was not fitted to, if the runs are replayed better with it than by the best that the
    catalogue can do, and stretches that took no part in anything no worse, and if nothing is left
    on its axis but noise: half a law is a wrong one.

    Args:
        selection: what the search selected.
        catalogued: the best model of catalogued effects.
        base: the model that is diagnosed.
        gate: stretches that were kept apart.
        runs: all train runs.
        polish: fits once more to all runs.
    """
    if not installed("equations"):
        return None
    judged = seek_law(selection.workspace, selection.found)
    if judged is None or not _holds(judged, selection, catalogued, gate):
        return None
    fit, bank = polish(judged.fit)
    if not np.isfinite(fit.likelihood):
        return None
    sizes, axis = _measure(judged.terms, fit, runs)
    if any(left.axis == axis for left in find_structure(fit, bank)):
        return None
    bare = split_law(fit.hypothesis)[0].model
    errors = score_windows([base, bare, fit.hypothesis.model], runs).normalised
    start, before, after = (or_nan(e) for e in errors)
    rivals = tuple((write_equation(r.terms), judged.score - r.score) for r in judged.rivals)
    return ProposedLaw(judged.terms, fit, (before - after) / start, sizes, axis, rivals)


def _holds(judged: Judged, selection: Selection, catalogued: Model, gate: Gate) -> bool:
    workspace = selection.workspace
    rest: Hypothesis = split_law(judged.fit.hypothesis)[0]
    if cross_validate(judged.fit, workspace.fit(rest), workspace.bank) <= 0.0:
        return False
    return gate.favours(judged.fit.hypothesis.model, catalogued, ENOUGH)


def _measure(
    terms: Sequence[LawTerm], fit: Fit, runs: Sequence[ObservedRun]
) -> tuple[tuple[float, ...], str]:
    """RMS of each term in N or N m, and the axis where it stands out most from the disturbance."""
    law, model = split_law(fit.hypothesis)[1], split_law(fit.hypothesis)[0].model
    assert law is not None
    middle = middle_of(runs)
    sign = runs[0].motion.site.axes
    middle[:3] = [law.effect[n] * s for n, s in zip("xyz", sign, strict=True)]
    middle[3] = law.effect["width"]
    known = [LawTerm(t.on, t.factors) for t in terms]
    c = [law.effect[f"c{k}"] * law.effect[f"size{k}"] for k in range(1, len(terms) + 1)]
    pushes = np.concatenate([push(known, run, model, middle) for run in runs], axis=1)
    pushes *= np.array(c)[:, None, None]
    whole = np.sqrt(np.mean((pushes.sum(axis=0) @ model.body.M_inv.T) ** 2, axis=0))
    sizes = np.sqrt(np.mean(np.sum(pushes**2, axis=2), axis=1))
    return tuple(float(s) for s in sizes), AXES[int(np.argmax(whole / fit.noise.level))]


def list_quantities(term: LawTerm) -> tuple[str, ...]:
    """What a term varies with: velocities by their symbols, attitude, place, depth, speed."""
    found = [_QUANTITY.get(VARIABLES[k].meaning, VARIABLES[k].symbol) for k in term.factors]
    found += ["place"] if term.on == SWIRL else []
    plain = [name.replace("|", "").removeprefix("sign(").rstrip(")") for name in found]
    return tuple(dict.fromkeys(plain))


_QUANTITY = {
    "place along north": "place", "place along east": "place", "one place": "place",
    "depth": "depth", "speed": "speed", "pitch": "attitude", "roll": "attitude",
    "uprightness": "attitude",
}  # fmt: skip


def name_target(term: LawTerm) -> str:
    """What a term acts on: an axis, `force` along the world's axes, or `water`."""
    if term.on < WORLD:
        return ON[term.on]
    return "force" if term.on < WATER else "water"
