"""Values that are known only together: the runs fix what they do jointly, not each of them."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from rovsim.diagnosis.selection.gauss_newton import Fit

ALIKE = 0.95  # correlation; each would be three times as sure if the other were known
UNSURE = 2.0  # standard deviations: the value could as well be that of absence


def group_joint_parameters(found: Fit) -> list[list[str]]:
    """Groups of parameters, as `effect.parameter`, the largest group first."""
    h, std = found.hypothesis, np.maximum(found.std, 1e-12)
    names = [f"{term.id}.{p.name}" for term in h.terms for p in term.parameters]
    unsure = np.flatnonzero(np.abs(h.x - h.absence) < UNSURE * std)
    correlation = found.covariance / np.outer(std, std)
    alike = np.abs(correlation[np.ix_(unsure, unsure)]) > ALIKE
    _, label = connected_components(alike, directed=False)
    groups = [[names[k] for k in unsure[label == g]] for g in range(label.max(initial=-1) + 1)]
    return sorted((g for g in groups if len(g) > 1), key=lambda g: (-len(g), g))
