"""Does a name only imitate physics that the catalogue does not have?

Where a drag law of no name is more likely than the linear and quadratic drag that were selected,
those go, and the verdict says that something is unexplained.
"""

from dataclasses import replace

from rovsim import AXES
from rovsim.diagnosis.checks.residual_structure import Structure
from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.unlisted_drag import UNLISTED_DRAG
from rovsim.diagnosis.selection.forward_selection import SURE
from rovsim.diagnosis.selection.gauss_newton import Fit
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.base import Wrench

IMITATORS = ("linear_damping", "quadratic_damping")


def drop_imitations(workspace: SearchWorkspace, found: Fit) -> tuple[Fit, list[Structure]]:
    """The fit without drag that a law of no name explains better, and what that law is."""
    h = found.hypothesis
    drag = [term for term in h.terms if term.id in IMITATORS]
    if not drag:
        return found, []
    rest = replace(h, terms=tuple(term for term in h.terms if term.id not in IMITATORS))
    axes = tuple(axis for axis in AXES if any(axis in term.free for term in drag))
    trials = [(cls, workspace.fit(_with(rest, cls, axes))) for cls in UNLISTED_DRAG]
    cls, best = max(trials, key=lambda one: workspace.score(one[1]))
    gain = workspace.score(best) - workspace.score(found)
    if gain < SURE:
        return found, []
    law = (cls.__doc__ or "").rstrip(".").lower()
    names = " and ".join(term.id for term in drag)
    what = f"{law}, rather than {names}"
    return workspace.fit(rest), [Structure(axes[0], what, 1.0, gain / SURE)]


def _with(rest: Hypothesis, cls: type[Wrench], axes: tuple[str, ...]) -> Hypothesis:
    return rest.with_term(Term(cls(), axes))
