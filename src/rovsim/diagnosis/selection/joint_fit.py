"""Where much is missing at once: fit everything that may be wrong, then remove what is not needed.

A search that adds effects one by one judges each addition while all else is still missing. Thrust,
drag and inertia depend on each other. Where all three are wrong, the likeliest single change may
lead away from the truth (a vehicle four times as heavy). So all values of the vehicle file are
freed together, once for each way in which commands may act. The special effects that a search found
are added to the likeliest fit, so that none is lost without having competed, and it is pruned.
"""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.threads import map_on_cores
from rovsim.diagnosis.selection.pruning import drop_parameters
from rovsim.diagnosis.selection.search_result import Rival, SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.buoyancy import BuoyancyCenter, NetBuoyancy
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.dynamics.effects.onboard_control import ALL_LOOPS_START, OnboardControl
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import DRAG, free_terms, mark_gain
from rovsim.estimation.fit import PRIOR_STD, Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

FIT_ROUNDS = 2  # the filters suit the model and the noise of the round before
# Ways in which commands could act.
ACTUATION_IDS = (ThrusterGain.id, OnboardControl.id)
COMMON_EFFECTS = (*DRAG, AddedMass, NetBuoyancy, BuoyancyCenter, ConstantWrench, InputDelay)


def fit_jointly(
    workspace: SearchWorkspace, base: Model, moved: Sequence[str], found: Sequence[Term] = ()
) -> SearchResult:
    """Make all joint fits, and prune the likeliest; other ways in which commands act are rivals.

    Args:
        workspace: of the search, as it began.
        base: the model that is diagnosed.
        moved: axes that were measured and moved.
        found: terms that a search accepted.
    """
    kind = workspace.bank.runs[0].motion.commands.kind
    starts = _list_starts(base, moved, kind)
    results = map_on_cores(lambda start: _fit_in_rounds(workspace, start), starts)
    results.sort(key=lambda pair: pair[0].score(pair[1]), reverse=True)
    best_workspace, best_fit = results[0]
    best_fit = prune_together(best_workspace, add_found(best_workspace, best_fit, found))
    names = {term.id for term in best_fit.hypothesis.terms}
    rivals = tuple(
        Rival(
            term.id, best_term.id, best_workspace.score(best_fit) - other_workspace.score(fit), fit
        )
        for other_workspace, fit in results[1:]
        for best_term in best_fit.hypothesis.terms
        for term in fit.hypothesis.terms
        if best_term.id in ACTUATION_IDS and term.id in ACTUATION_IDS and term.id not in names
    )
    return SearchResult(best_workspace, best_fit, rivals, PRIOR_STD)


def _list_starts(base: Model, moved: Sequence[str], kind: str) -> list[Hypothesis]:
    common_terms = free_terms(base, moved, COMMON_EFFECTS)
    starts = [(*common_terms, *free_terms(base, moved, [ThrusterGain]))]
    if kind == "demand":
        loops = Term(OnboardControl(**ALL_LOOPS_START), OnboardControl.free_at(ALL_LOOPS_START))
        starts.append((*common_terms, loops))
    return [Hypothesis(base, terms) for terms in starts]


def _fit_in_rounds(workspace: SearchWorkspace, start: Hypothesis) -> tuple[SearchWorkspace, Fit]:
    """Fit a hypothesis, and twice again with filters and noise that suit the fit before."""
    fit = workspace.fit(start, PRIOR_STD)
    for _ in range(FIT_ROUNDS):
        workspace, fit = workspace.refit_updated(fit, PRIOR_STD)
    return workspace, fit


def add_found(workspace: SearchWorkspace, fit: Fit, found: Sequence[Term]) -> Fit:
    """The fit with what a search found besides, where that is likelier."""
    h = fit.hypothesis
    new = tuple(t for t in found if t.id not in {term.id for term in h.terms})
    if not new:
        return fit
    extended = workspace.fit(replace(h, terms=(*h.terms, *new)), PRIOR_STD)
    return extended if workspace.score(extended) > workspace.score(fit) else fit


def prune_together(workspace: SearchWorkspace, fit: Fit) -> Fit:
    """Remove all parameters at once that are not worth their penalty, until none is left.

    Where thrust, inertia and drag are only known up to a common factor, none of them is sure but
    all are needed. Then only the gain of the thrusters is set back to the file's, which determines
    the factor.
    """
    while True:
        weak = _find_weak(fit, workspace.penalty)
        for mask in (weak, weak & mark_gain(fit.hypothesis)):
            pruned = _do_without(workspace, fit, mask)
            if pruned is not None:
                break
        else:
            return fit
        fit = pruned


def _do_without(workspace: SearchWorkspace, fit: Fit, weak: Array) -> Fit | None:
    """The fit without the free parameters of a mask (k,); None where they are needed."""
    if not weak.any():
        return None
    pruned = workspace.fit(drop_parameters(fit.hypothesis, weak), PRIOR_STD)
    return pruned if workspace.score(pruned) >= workspace.score(fit) else None


def _find_weak(fit: Fit, penalty: float) -> Array:
    """Mask (k,) of free parameters that are not worth their penalty; of a loop all or none."""
    h = fit.hypothesis
    weak = fit.z_scores**2 < penalty
    for term, columns in zip(h.terms, h.columns, strict=True):
        if not term.vanishes:
            weak[columns] = weak[columns].all()
    return np.asarray(weak & ~h.shapes)
