"""Remove free parameters that are not worth their penalty."""

from dataclasses import replace

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis


def prune(workspace: SearchWorkspace, current: Fit) -> Fit:
    """Remove free parameters that are not worth their penalty, one at a time.

    A hypothesis whose model diverges stays as it is: what its parameters are worth is not known.
    """
    while len(current.hypothesis.x) and current.is_finite:
        reduced = _drop_weakest(workspace, current)
        if reduced is None:
            return current
        trial = workspace.fit(reduced)
        if workspace.score(trial) < workspace.score(current):
            return current
        current = trial
    return current


def _drop_weakest(workspace: SearchWorkspace, current: Fit) -> Hypothesis | None:
    """The hypothesis without its least certain parameter; None if all of them are sure."""
    h = current.hypothesis
    z_squares = current.z_scores**2
    for term, columns in zip(h.terms, h.columns, strict=True):
        if columns and not term.vanishes:  # such a term can only be removed as a whole
            z_squares[columns] = np.max(z_squares[columns])
    z_squares[h.shapes] = np.inf
    weakest = int(np.argmin(np.nan_to_num(z_squares, nan=np.inf)))
    if not z_squares[weakest] < 2.0 * workspace.penalty:
        return None
    return drop_parameters(h, np.arange(len(z_squares)) == weakest)


def drop_parameters(h: Hypothesis, weak: Array) -> Hypothesis:
    """The hypothesis without the free parameters of a mask (k,), and without terms left with none.

    A term that still acts at its defaults is removed as a whole, with the first of its parameters.
    Parameters that are shapes are removed with the last of the others.
    """
    terms = []
    for term, columns in zip(h.terms, h.columns, strict=True):
        idle = {name for name, k in zip(term.free, columns, strict=True) if weak[k]}
        if all(p.shape or p.name in idle for p in term.parameters):
            idle = set(term.free)
        defaults = {p.name: p.default for p in term.parameters if p.name in idle}
        free = tuple(name for name in term.free if name not in idle)
        if not term.free:
            terms.append(term)  # tried, not fitted: it has nothing to drop
        elif free and (not idle or term.vanishes):
            terms.append(replace(term, effect=term.effect.with_values(defaults), free=free))
    return Hypothesis(h.base, tuple(terms))
