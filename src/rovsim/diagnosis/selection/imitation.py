"""Parameters that seem sure only because what they imitate is far from where a fit stands."""

from dataclasses import replace
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.pruning import drop_parameters, prune
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term

UNDETERMINED_Z = 1.0  # of a parameter that may as well be absent, by its standard deviation


def drop_imitations(workspace: SearchWorkspace, current: Fit) -> Fit:
    """Remove parameters that undetermined ones of another effect make unnecessary.

    A loop on board resists a motion as drag does. At a bandwidth near zero and a gain as large as
    need be it only pushes, and drag beside it seems sure: no linearisation there shows that a
    larger bandwidth does without the drag. So the undetermined parameters begin anew where a fit of
    their effect does, without the parameter that is most correlated with them. The result is kept
    where it is likelier.
    """
    if not current.is_finite:
        return current
    h = current.hypothesis
    for i, own in enumerate(h.columns):
        undetermined = [k for k in own if abs(current.z_scores[k]) < UNDETERMINED_Z]
        others = np.setdiff1d(np.arange(len(h.x)), own)
        if not undetermined or not len(others):
            continue
        names = [h.terms[i].free[k - own[0]] for k in undetermined]
        start = h.replaced(i, _begin_anew(workspace, h.terms[i], names))
        imitation = _most_correlated(current.covariance, undetermined, others)
        start = drop_parameters(start, np.arange(len(h.x)) == imitation)
        trial = prune(workspace, workspace.fit(start))
        if workspace.score(trial) > workspace.score(current):
            return drop_imitations(workspace, trial)
    return current


def _begin_anew(workspace: SearchWorkspace, term: Term, names: Sequence[str]) -> Term:
    """The term with these parameters where a fit of its effect begins, if it begins with them."""
    starts = [block.candidate.term() for block in workspace.sensitivities.blocks]
    values = {
        name: start.effect[name]
        for start in reversed(starts)  # the first that has it counts
        if start.id == term.id
        for name in names
        if name in start.free
    }
    return replace(term, effect=term.effect.with_values(values))


def _most_correlated(covariance: Array, with_any: Sequence[int], others: Array) -> int:
    """Which of some parameters is most correlated with any of others, by their numbers."""
    std = np.sqrt(np.diag(covariance))
    correlation = np.abs(covariance / np.outer(std, std))[np.ix_(np.asarray(with_any), others)]
    return int(others[np.argmax(np.max(correlation, axis=0))])
