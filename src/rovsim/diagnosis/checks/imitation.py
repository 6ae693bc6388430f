"""Does a name only imitate physics that the catalogue does not have?

Where a drag law of no name is more likely than the linear and quadratic drag that were selected,
those go, and the verdict says that something is unexplained.
"""

from dataclasses import replace

from rovsim import AXES
from rovsim.diagnosis.checks.residual import Structure
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.unlisted_drag import UNLISTED_DRAG
from rovsim.diagnosis.selection.rivals import SURE, Selection
from rovsim.dynamics.effects.base import Wrench

IMITATORS = ("linear_damping", "quadratic_damping")


def drop_imitations(selection: Selection) -> tuple[Selection, list[Structure]]:
    """The selection without drag that a law of no name explains better, and what that law is."""
    workspace, found = selection.workspace, selection.found
    h = found.hypothesis
    drag = [term for term in h.terms if term.id in IMITATORS]
    if not drag:
        return selection, []
    rest = replace(h, terms=tuple(term for term in h.terms if term.id not in IMITATORS))
    axes = tuple(axis for axis in AXES if any(axis in term.free for term in drag))
    trials = [(cls, workspace.fit(_with(rest, cls, axes))) for cls in UNLISTED_DRAG]
    cls, best = max(trials, key=lambda one: workspace.score(one[1]))
    gain = workspace.score(best) - workspace.score(found)
    if gain < SURE:
        return selection, []
    law = (cls.__doc__ or "").rstrip(".").lower()
    names = " and ".join(term.id for term in drag)
    what = f"{law}, rather than {names}"
    imitated = Structure(axis=axes[0], what=what, share=1.0, surprise=gain / SURE)
    return replace(selection, found=workspace.fit(rest)), [imitated]


def _with(rest: Hypothesis, cls: type[Wrench], axes: tuple[str, ...]) -> Hypothesis:
    return rest.with_term(Term(cls(), axes))
