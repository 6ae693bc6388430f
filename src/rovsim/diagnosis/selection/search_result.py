"""Where a search ended: the effects that it accepted, and their rivals."""

from dataclasses import dataclass, field, replace
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
    """An effect that could stand in the place of an accepted one.

    Attributes:
        effect: id of the rival.
        instead_of: id of the accepted effect.
        deviance_difference: by how much less likely the rival is: the difference of the scores
            (twice the log likelihood, less penalties). 6 means odds of 20 to 1. A lower limit where
            the fit of the rival was given up.
        fit: with the rival in the place of the effect; None where it was not refitted.
    """

    effect: str
    instead_of: str
    deviance_difference: float
    fit: Fit | None = field(default=None, compare=False, repr=False)


def keep_likeliest(rivals: Iterable[Rival]) -> tuple[Rival, ...]:
    """Of rivals with the same effect in the same place, keep the likeliest."""
    by_pair: dict[tuple[str, str], Rival] = {}
    for rival in rivals:
        previous = by_pair.setdefault((rival.instead_of, rival.effect), rival)
        if rival.deviance_difference < previous.deviance_difference:
            by_pair[rival.instead_of, rival.effect] = rival
    return tuple(by_pair.values())


@dataclass(frozen=True, eq=False)
class SearchResult:
    """Where a search ended.

    Attributes:
        workspace: of the search, as it was at its end.
        best: the fit with all accepted effects.
        rivals: effects that could stand in the place of accepted ones.
        prior_std: standard deviation, in scales of the parameters, of a prior about the start of
            each fit. It is infinite where effects were accepted one by one. In a joint fit, the
            prior keeps parameters that only act together near their start.
        stopped: whether the most effects that a search may add ended it, and not the evidence.
    """

    workspace: SearchWorkspace
    best: Fit
    rivals: tuple[Rival, ...]
    prior_std: float = np.inf
    stopped: bool = False

    @property
    def is_joint(self) -> bool:
        """Whether the effects were fitted jointly, and not accepted one by one."""
        return bool(np.isfinite(self.prior_std))

    def fit(self, start: Hypothesis) -> Fit:
        """Fit another hypothesis in the same way as the accepted one."""
        return self.workspace.fit(start, self.prior_std)

    def fit_unless_below(self, start: Hypothesis, current: Fit, least: float) -> Fit | None:
        """As `fit`, but None as soon as the score will surely not reach `least`.

        See `SearchWorkspace.fit_unless_below`.
        """
        return self.workspace.fit_unless_below(start, current, least, self.prior_std)

    def without_effect(self, effect_id: str) -> "SearchResult | None":
        """The same without an effect, the others refitted; None where the model then diverges."""
        fit = self.fit(self.best.hypothesis.without_effect(effect_id))
        return replace(self, best=fit) if fit.is_finite else None

    def prune(self, workspace: SearchWorkspace, fit: Fit) -> Fit:
        """Remove from a fit of the selection what is not worth its penalty.

        A joint fit stays as it is: none of its effects is sure by itself, but all are needed.
        """
        return fit if self.is_joint else prune(workspace, fit)

    @property
    def named_rivals(self) -> list[Rival]:
        """The rivals of effects that are still in the model."""
        ids = {term.id for term in self.best.hypothesis.terms}
        return [rival for rival in self.rivals if rival.instead_of in ids]
