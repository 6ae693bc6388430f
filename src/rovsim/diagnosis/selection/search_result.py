"""Where a search ended, and what else the effects it found could be."""

from dataclasses import dataclass, field
from typing import Iterable

import numpy as np

from rovsim.core.odds import lr_statistic_of
from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis

MIN_LR_APART = lr_statistic_of(odds=20.0)


@dataclass(frozen=True)
class Rival:
    """An effect that could stand in for a selected one, and by how much it is less likely.

    `deviance_difference` includes penalties: 6 are odds of 20 to 1; at least that much where its
    fit was given up. `fit` with it in the other's place, where it was refitted.
    """

    effect: str
    instead_of: str
    deviance_difference: float
    fit: Fit | None = field(default=None, compare=False, repr=False)


def keep_likeliest(rivals: Iterable[Rival]) -> tuple[Rival, ...]:
    """Each that stands for the same once, as it is likeliest."""
    best: dict[tuple[str, str], Rival] = {}
    for one in rivals:
        known = best.setdefault((one.instead_of, one.effect), one)
        if one.deviance_difference < known.deviance_difference:
            best[one.instead_of, one.effect] = one
    return tuple(best.values())


@dataclass(frozen=True, eq=False)
class SearchResult:
    """What a search found, its rivals, and the workspace as it was then.

    `reach`: how far a fit may go from where it starts, in scales. Without end where terms were
    found one by one, each sure beside the others; where all that could be wrong was fitted at once,
    what acts only together is kept near where it began.
    """

    workspace: SearchWorkspace
    best: Fit
    rivals: tuple[Rival, ...]
    reach: float = np.inf

    def fit(self, start: Hypothesis) -> Fit:
        """Fit another hypothesis as this one was found."""
        return self.workspace.fit(start, self.reach)

    def fit_unless_worse(self, start: Hypothesis, current: Fit, score: float) -> Fit | None:
        """The same, but None as soon as it surely does not come near a score.

        `current`: a fit whose derivatives it may begin with.
        """
        return self.workspace.fit_unless_worse(start, current, score, self.reach)

    def prune(self, workspace: SearchWorkspace, fit: Fit) -> Fit:
        """Without what is not worth its penalty to a fit of the selection.

        What was fitted at once stays: none of it is sure by itself, and all is needed.
        """
        return prune(workspace, fit) if np.isinf(self.reach) else fit

    @property
    def named_rivals(self) -> list[Rival]:
        """The rivals of what is still in the model."""
        named = {term.id for term in self.best.hypothesis.terms}
        return [rival for rival in self.rivals if rival.instead_of in named]
