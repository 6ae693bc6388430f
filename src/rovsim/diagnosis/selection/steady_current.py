"""A steady current, or one that wanders?

Missing effects that act beyond first order can look like a current that wanders a little. A current
that wanders also explains a steady one, which would then never be proposed. So both are fitted.
"""

from dataclasses import replace

from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.current import Current
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term


def prefer_steady(workspace: SearchWorkspace, current: Fit) -> tuple[SearchWorkspace, Fit]:
    """Replace a wandering current by a steady one, where that is likelier.

    The noise is then fitted to what the steady current leaves. A wandering current explains too
    much, and beside it no other effect would be found.
    """
    h = current.hypothesis
    if not workspace.noise.drift or Current.id in (term.id for term in h.terms):
        return workspace, current
    without_drift = workspace.with_noise(h, replace(workspace.noise, drift=None))
    steady_fit = without_drift.fit(h.with_term(Term(Current(), Current.telling)))
    if not without_drift.score(steady_fit) > workspace.score(current):
        return workspace, current
    updated = without_drift.update_after(steady_fit)
    if updated.noise.drift:
        return workspace, current
    return updated, prune(updated, updated.fit(steady_fit.hypothesis))
