"""Which fitted values are only known together with others, and which may as well be absent."""

import numpy as np
from numpy import ndarray as Array
from scipy.sparse.csgraph import connected_components
from scipy.stats import chi2

from rovsim.estimation.fit import Fit

# Correlation; each would be three times as sure if the other were known.
CONFUSED_CORRELATION = 0.95
UNSURE_STDS = 2.0  # standard deviations: the value could as well be that of absence
MIN_ABSENCE_CHANCE = 0.01  # chance of values as far from absence


def group_joint_parameters(fit: Fit) -> list[list[str]]:
    """Groups of parameters that are only known together, the largest group first.

    Parameters are named `effect.parameter`. In a group all are unsure, and strongly correlated.
    """
    names = fit.hypothesis.parameter_names
    unsure = np.flatnonzero(np.abs(fit.z_scores) < UNSURE_STDS)
    joint = np.abs(fit.correlation[np.ix_(unsure, unsure)]) > CONFUSED_CORRELATION
    groups = [[names[k] for k in unsure[group]] for group in group_connected(joint)]
    return sorted((g for g in groups if len(g) > 1), key=lambda g: (-len(g), g))


def group_connected(adjacency: Array) -> list[Array]:
    """Indices of the members of each connected group of n things, of which (n, n) are adjacent."""
    _, label = connected_components(adjacency, directed=False)
    return [np.flatnonzero(label == group) for group in range(label.max(initial=-1) + 1)]


def find_doubtful(fit: Fit) -> int | None:
    """Index of the term that is the likeliest to be absent; None where all are surely there.

    Terms that are only known together with others are not considered: without one, the others
    would seem sure.
    """
    joint_ids = {name.split(".")[0] for group in group_joint_parameters(fit) for name in group}
    joint = np.array([term.id in joint_ids for term in fit.hypothesis.terms], dtype=bool)
    chances = np.where(joint, 0.0, _chances_of_absence(fit))
    likeliest = int(np.argmax(chances))
    return likeliest if chances[likeliest] > MIN_ABSENCE_CHANCE else None


def find_perhaps_absent(fit: Fit) -> set[str]:
    """Ids of the terms whose values, as far as they are known, may all be those of absence."""
    pairs = zip(fit.hypothesis.terms, _chances_of_absence(fit), strict=True)
    return {term.id for term, chance in pairs if chance > MIN_ABSENCE_CHANCE}


def _chances_of_absence(fit: Fit) -> Array:
    """Chance (t,) that absence gives values as far from it, for each term; 0 where none is free."""
    h = fit.hypothesis
    return np.array(
        [chi2.sf(fit.wald_statistic(own), len(own)) if own else 0.0 for own in h.columns]
    )
