"""Accepted effects: their fitted values, how sure these are, and how sure their names."""

from dataclasses import dataclass, field
from typing import Sequence

from rovsim.core.odds import probability_of, share_odds
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.current import CurrentDrift
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.camera import Smoothing
from rovsim.estimation.observer.drifting_current import DriftFit
from rovsim.estimation.observer.hypothesis import Term
from rovsim.results.fitted import Doubt


@dataclass(frozen=True, eq=False)
class AcceptedEffect:
    """An accepted effect.

    Attributes:
        term: the effect at its fitted values.
        std: standard deviations of the fitted parameters, by name, in their units.
        probability: of this effect among all that were tried in its place; None where unknown.
        doubt: why it is unknown although others were tried.
    """

    term: Term
    std: dict[str, float]
    probability: float | None
    doubt: Doubt | None = field(default=None, kw_only=True)

    @property
    def leads(self) -> bool:
        """Whether it says that the vehicle moves before its command: a negative delay."""
        return isinstance(self.term.effect, InputDelay) and self.term.effect["delay"] < 0.0


def name_terms(fit: Fit, rivals: Sequence[Rival]) -> list[AcceptedEffect]:
    """The effects of a fit, with how sure their values and their names are."""
    return [
        AcceptedEffect(term, find_std(fit, i), _share_of_odds(fit, i, rivals))
        for i, term in enumerate(fit.hypothesis.terms)
    ]


def name_smoothing(smoothing: Smoothing) -> AcceptedEffect:
    """The filter of the cameras, as an effect whose only rival is unfiltered noise."""
    term = Term(smoothing.effect, ("cutoff",))
    return AcceptedEffect(term, {"cutoff": smoothing.std}, probability_of(smoothing.lr_statistic))


def name_drift(drift: DriftFit, leaves_physics: bool) -> AcceptedEffect:
    """A wandering current, as an effect whose rivals are forces that wander.

    No replay can predict it, so it removes no error.

    Args:
        drift: the likeliest drift.
        leaves_physics: whether the accepted effects leave physics that none of them describes. That
            may be what seems to wander, so the effect then has no probability.
    """
    term = Term(CurrentDrift(rate=drift.rate.value), ("rate",))
    std = {"rate": drift.rate.std}
    if leaves_physics:
        return AcceptedEffect(term, std, None, doubt="wanders")
    return AcceptedEffect(term, std, probability_of(drift.lr_margin))


def find_std(fit: Fit, i: int) -> dict[str, float]:
    """Standard deviations of the i-th effect's fitted parameters, by name, in their units."""
    term, columns = fit.hypothesis.terms[i], fit.hypothesis.columns[i]
    return {p.name: p.std_of(fit.std[k]) for p, k in zip(term.parameters, columns, strict=True)}


def _share_of_odds(fit: Fit, i: int, rivals: Sequence[Rival]) -> float | None:
    """Probability of the i-th effect among all that were tried in its place; None if none was."""
    name = fit.hypothesis.terms[i].id
    log_odds = [-r.deviance_difference for r in rivals if r.instead_of == name]
    return float(share_odds([0.0, *log_odds])[0]) if log_odds else None
