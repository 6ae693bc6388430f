"""A steady current, or one that wanders?

What is missing and not foreseen to first order can pass for a current that wanders a little. That
takes a steady one with it, which nothing then asks for, so the two are fitted side by side.
"""

from dataclasses import replace

from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.current import Current
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term


def prefer_steady(workspace: SearchWorkspace, current: Fit) -> tuple[SearchWorkspace, Fit]:
    """A steady current in the place of one that wanders, where that is likelier.

    The noise is then that of what the steady one leaves: one that wanders takes more than its due,
    and under the little that it leaves nothing else would be seen.
    """
    h = current.hypothesis
    if not workspace.noise.drift or Current.id in (term.id for term in h.terms):
        return workspace, current
    calm = workspace.with_noise(h, replace(workspace.noise, drift=None))
    steady = calm.fit(h.with_term(Term(Current(), Current.telling)))
    if not calm.score(steady) > workspace.score(current):
        return workspace, current
    fresh = calm.update_after(steady)
    if fresh.noise.drift:
        return workspace, current
    return fresh, prune(fresh, fresh.fit(steady.hypothesis))
