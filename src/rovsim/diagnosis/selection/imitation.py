"""Parameters that seem sure only because what they imitate is far from where a fit stands."""

from dataclasses import replace
from typing import Sequence

import numpy as np

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
    h, numbers = current.hypothesis, np.arange(len(current.hypothesis.x))
    undetermined = np.abs(current.z_scores) < UNDETERMINED_Z
    correlation = np.abs(current.correlation)
    for i, (term, own) in enumerate(zip(h.terms, h.columns, strict=True)):
        loose, others = undetermined & np.isin(numbers, own), np.setdiff1d(numbers, own)
        if not loose.any() or not len(others):
            continue
        names = [name for name, k in zip(term.free, own, strict=True) if loose[k]]
        imitation = others[np.argmax(correlation[loose][:, others].max(axis=0))]
        start = h.replaced(i, _restart_term(workspace, term, names))
        start = drop_parameters(start, numbers == imitation)
        trial = prune(workspace, workspace.fit(start))
        if workspace.score(trial) > workspace.score(current):
            return drop_imitations(workspace, trial)
    return current


def _restart_term(workspace: SearchWorkspace, term: Term, names: Sequence[str]) -> Term:
    """The term with these parameters where a fit of its effect begins, if it begins with them."""
    values = {
        name: start.effect[name]
        for start in reversed(workspace.list_starts(term))  # the first that has it counts
        for name in names
        if name in start.free
    }
    return replace(term, effect=term.effect.with_values(values))
