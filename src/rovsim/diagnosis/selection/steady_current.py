"""A steady current, or one that wanders?

Missing effects that act beyond first order can look like a current that wanders a little, and a
current that wanders also explains a steady one, which would then never be proposed. The other way
round, one that wanders slowly looks like a steady one. So both are fitted, before effects are added
and after.
"""

from dataclasses import replace

from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.current import Current, CurrentDrift
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.drifting_current import MIN_LR_OF_DRIFT
from rovsim.estimation.observer.hypothesis import Term
from rovsim.estimation.observer.noise import DriftingCurrent


def prefer_steady(workspace: SearchWorkspace, current: Fit) -> tuple[SearchWorkspace, Fit]:
    """Replace a wandering current by a steady one, where that is likelier.

    The noise is then fitted to what the steady current leaves. A wandering current explains too
    much, and beside it no other effect would be found.
    """
    h = current.hypothesis
    if not workspace.noise.drift or _steady_of(current) is not None:
        return workspace, current
    without_drift = workspace.with_noise(h, replace(workspace.noise, drift=None))
    steady_fit = without_drift.fit(h.with_term(Term(Current(), Current.telling)))
    if not without_drift.score(steady_fit) > workspace.score(current):
        return workspace, current
    updated, refit = without_drift.refit_updated(steady_fit)
    return (workspace, current) if updated.noise.drift else (updated, prune(updated, refit))


def challenge_steady(
    workspace: SearchWorkspace, current: Fit
) -> tuple[SearchWorkspace, Fit, list[Rival]]:
    """Try a current that wanders in the place of an accepted steady one.

    It takes that place where it is likelier, and surely likelier than forces that wander and than a
    current that differs from place to place. Its rate counts as one parameter.

    Args:
        workspace: of a search that adds nothing more.
        current: what the search accepted.

    Returns:
        The workspace and the fit, with the wandering current in the noise where it is preferred;
        else the wandering current as a rival of the steady one.
    """
    steady = _steady_of(current)
    if steady is None or workspace.noise.drift or not workspace.bank.looks_for_drift:
        return workspace, current, []
    (start,) = workspace.first_order.drop(current, [[steady]])
    still = workspace.fit(start)
    if not still.is_finite:
        return workspace, current, []
    drift = workspace.bank.measure_drift(still.linearised.e, workspace.noise)
    if drift.rate.lr_statistic < MIN_LR_OF_DRIFT:
        return workspace, current, []
    noise = replace(workspace.noise, drift=DriftingCurrent(drift.rate.value))
    moving = workspace.with_noise(start, noise)
    wandering = moving.fit(start)
    worse = workspace.score(current) - (moving.score(wandering) - moving.penalty)
    if worse < 0.0 and drift.sure:
        return moving, prune(moving, wandering), []
    return workspace, current, [Rival(CurrentDrift.id, steady.id, max(0.0, worse))]


def _steady_of(fit: Fit) -> Term | None:
    return next((term for term in fit.hypothesis.terms if term.id == Current.id), None)
