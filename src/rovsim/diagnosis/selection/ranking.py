"""Rank the accepted effects by the error they remove, and every effect as the only addition."""

from dataclasses import dataclass, replace
from typing import Collection, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.odds import probability_of, share_odds
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.current import CurrentDrift
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.camera import Smoothing
from rovsim.estimation.observer.drifting_current import DriftFit
from rovsim.estimation.observer.hypothesis import Term
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.windows import score_windows
from rovsim.results.diagnosis import bound_unexplained

CHANGED_SHARE = 0.5  # of an effect: more is not the same effect beside something else


@dataclass(frozen=True, eq=False)
class Named:
    """An accepted effect.

    Attributes:
        term: the effect at its fitted values.
        std: standard deviations of the fitted parameters, by name, in their units.
        probability: of this effect among all that were tried in its place; None where unknown.
    """

    term: Term
    std: dict[str, float]
    probability: float | None


@dataclass(frozen=True, eq=False)
class Selected(Named):
    """An accepted effect, and the share of the base's error that it removes."""

    error_reduction: float


@dataclass(frozen=True, eq=False)
class Ranked:
    """An effect as the only addition to the base.

    Attributes:
        term: the effect at its fitted values.
        error_reduction: share of the base's error that it removes.
        probability: that it is the only missing effect, if at most one is.
    """

    term: Term
    error_reduction: float
    probability: float


def rank_selected(
    base: Model, named: Sequence[Named], runs: Sequence[ObservedRun]
) -> list[Selected]:
    """Order accepted effects: first the one that removes most error, then the next beside it.

    Args:
        base: the model without these effects.
        named: the effects.
        runs: on which the error is measured, in windows of 2 s.
    """
    remaining, selected, model = list(named), [], base
    base_error = error = _score([base], runs)[0]
    while remaining:
        models = [model + n.term.effect for n in remaining]
        errors = _score(models, runs)
        k_best = int(np.argmin(np.nan_to_num(errors, nan=np.inf)))
        best = remaining.pop(k_best)
        selected.append(
            Selected(
                best.term, best.std, best.probability, float((error - errors[k_best]) / base_error)
            )
        )
        model, error = models[k_best], errors[k_best]
    return selected


def name_terms(fit: Fit, rivals: Sequence[Rival]) -> list[Named]:
    """The effects of a fit, with how sure their values and their names are."""
    return [
        Named(term, find_std(fit, i), _share_of_odds(fit, i, rivals))
        for i, term in enumerate(fit.hypothesis.terms)
    ]


def name_smoothing(smoothing: Smoothing) -> Named:
    """The filter of the cameras, as an effect whose only rival is unfiltered noise."""
    term = Term(smoothing.effect, ("cutoff",))
    return Named(term, {"cutoff": smoothing.std}, probability_of(smoothing.lr_statistic))


def leads(one: Named) -> bool:
    """Whether the effect says that the vehicle moves before its command: a negative delay."""
    return isinstance(one.term.effect, InputDelay) and one.term.effect["delay"] < 0.0


def doubt_lead(named: Sequence[Named]) -> list[Named]:
    """The same without a probability for a negative delay, where the cameras smooth.

    Their filter may use later frames as well, and such a filter was not among the rivals.
    """
    return [replace(n, probability=None) if leads(n) else n for n in named]


def find_stand_ins(named: Sequence[Named], beside: Sequence[Named]) -> set[str]:
    """Ids of effects that a law makes unnecessary, or changes by more than half.

    Args:
        named: the accepted effects, fitted without the law.
        beside: the effects that are fitted together with the law.
    """
    acting = {n.term.id: n.term for n in beside}
    return {
        n.term.id for n in named if n.term.id not in acting or _differs(n.term, acting[n.term.id])
    }


def _differs(own: Term, other: Term) -> bool:
    """Whether two fits of an effect differ by more than half of what the first one changes."""
    if not (own.free and own.vanishes):
        return False
    names = [p for p in own.effect.parameters if p.name in own.free]
    neutral, values, others = (
        np.array([effect[p.name] / p.scale for p in names])
        for effect in (own.effect.neutral(), own.effect, other.effect)
    )
    return bool(np.linalg.norm(others - values) > CHANGED_SHARE * np.linalg.norm(values - neutral))


def doubt_names(named: Sequence[Named], doubted: Collection[str]) -> list[Named]:
    """The same, without a probability for the effects that are doubted."""
    return [replace(n, probability=None) if n.term.id in doubted else n for n in named]


def doubt_small(selected: Sequence[Selected], fraction: float | None) -> list[Selected]:
    """The same, without a probability for effects that remove less error than what is left causes.

    Likelihoods weigh effects rightly only where all else is noise. Where unknown physics is left,
    they favour the effect that happens to resemble it a little.

    Args:
        selected: the accepted effects.
        fraction: share of the remaining disturbance's power that follows the largest structure.
    """
    bound = bound_unexplained(fraction, [s.error_reduction for s in selected])
    return [replace(s, probability=None) if s.error_reduction < bound else s for s in selected]


def name_drift(drift: DriftFit, leaves_physics: bool) -> Named:
    """A wandering current, as an effect whose rivals are forces that wander.

    No replay can predict it, so it removes no error.

    Args:
        drift: the likeliest drift.
        leaves_physics: whether the accepted effects leave physics that none of them describes. That
            may be what seems to wander, so the effect then has no probability.
    """
    term = Term(CurrentDrift(rate=drift.rate.value), ("rate",))
    probability = None if leaves_physics else probability_of(drift.lr_margin)
    return Named(term, {"rate": drift.rate.std}, probability)


def _score(models: Sequence[Model], runs: Sequence[ObservedRun]) -> Array:
    errors = score_windows(models, runs).normalised
    return np.array([np.nan if e is None else e for e in errors])


def find_std(fit: Fit, i: int) -> dict[str, float]:
    """Standard deviations of the i-th effect's fitted parameters, by name, in their units."""
    term, columns = fit.hypothesis.terms[i], fit.hypothesis.columns[i]
    return {p.name: p.std_of(fit.std[k]) for p, k in zip(term.parameters, columns, strict=True)}


def _share_of_odds(fit: Fit, i: int, rivals: Sequence[Rival]) -> float | None:
    """Probability of the i-th effect among all that were tried in its place; None if none was."""
    name = fit.hypothesis.terms[i].id
    log_odds = [-r.deviance_difference for r in rivals if r.instead_of == name]
    return float(share_odds([0.0, *log_odds])[0]) if log_odds else None


def rank_alone(workspace: SearchWorkspace, base_fit: Fit, fit: Fit) -> list[Ranked]:
    """Rank every effect by how well it explains the runs as the only addition to the base.

    Effects that were refitted come first, by their likelihood; then the others, by what they
    promise to first order. The probabilities assume that at most one effect is missing.

    Args:
        workspace: of the search, as it began.
        base_fit: the base without any effect.
        fit: of the base with all accepted effects.
    """
    ids, proposals = ({term.id for term in fit.hypothesis.terms}, workspace.propose(base_fit))
    starts = [(p, base_fit.hypothesis.with_term(p.term)) for p in proposals]
    fits = [workspace.fit(h) for p, h in starts if p.term.id in ids or workspace.has_fitted(h)]
    fits.sort(key=workspace.score, reverse=True)
    terms = [f.hypothesis.terms[0] for f in fits]
    terms += [p.term for p in proposals if p.term.id not in {term.id for term in terms}]
    gains = [workspace.score(f) - workspace.score(base_fit) for f in fits]
    _, *share = share_odds([0.0, *gains])
    base = base_fit.hypothesis.base
    models = [base, *(base + term.effect for term in terms)]
    error = _score(models, workspace.bank.runs)
    probabilities = [*share, *np.zeros(len(terms) - len(fits))]
    return [
        Ranked(term, float(max(0.0, 1.0 - e / error[0])), float(p))
        for term, e, p in zip(terms, error[1:], probabilities, strict=True)
    ]
