"""Order the accepted effects by the error they remove; rank every effect as the only addition."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.odds import share_odds
from rovsim.diagnosis.selection.accepted_effects import AcceptedEffect
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.windows import score_windows
from rovsim.results.base import or_nan


@dataclass(frozen=True, eq=False)
class OrderedEffect(AcceptedEffect):
    """An accepted effect, and the share of the base's error that it removes."""

    error_reduction: float


@dataclass(frozen=True, eq=False)
class RankedEffect:
    """An effect as the only addition to the base.

    Attributes:
        term: the effect at its fitted values.
        error_reduction: share of the base's error that it removes.
        probability: that it is the only missing effect, if at most one is.
    """

    term: Term
    error_reduction: float
    probability: float


def order_accepted(
    base: Model, effects: Sequence[AcceptedEffect], runs: Sequence[ObservedRun]
) -> list[OrderedEffect]:
    """Order accepted effects: first the one that removes most error, then the next beside it.

    Args:
        base: the model without these effects.
        effects: the accepted effects.
        runs: on which the error is measured, in windows of 2 s.
    """
    remaining, ordered, model = list(effects), [], base
    base_error = error = _score([base], runs)[0]
    while remaining:
        models = [model + e.term.effect for e in remaining]
        errors = _score(models, runs)
        k_best = int(np.argmin(np.nan_to_num(errors, nan=np.inf)))
        best = remaining.pop(k_best)
        ordered.append(
            OrderedEffect(
                best.term,
                best.std,
                best.probability,
                float((error - errors[k_best]) / base_error),
                doubt=best.doubt,
            )
        )
        model, error = models[k_best], errors[k_best]
    return ordered


def rank_alone(workspace: SearchWorkspace, base_fit: Fit, fit: Fit) -> list[RankedEffect]:
    """Rank every effect by how well it explains the runs as the only addition to the base.

    Effects that were refitted come first, by their likelihood; then the others, by what they
    promise to first order. The probabilities assume that at most one effect is missing.

    Args:
        workspace: of the search, as it began.
        base_fit: the base without any effect.
        fit: of the base with all accepted effects.
    """
    ids = {term.id for term in fit.hypothesis.terms}
    proposals = workspace.first_order.propose(base_fit)
    starts = [(p, base_fit.hypothesis.with_term(p.term)) for p in proposals]
    fits = [workspace.fit(h) for p, h in starts if p.term.id in ids or workspace.fits.has_fitted(h)]
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
        RankedEffect(term, float(max(0.0, 1.0 - e / error[0])), float(p))
        for term, e, p in zip(terms, error[1:], probabilities, strict=True)
    ]


def _score(models: Sequence[Model], runs: Sequence[ObservedRun]) -> Array:
    errors = score_windows(models, runs).normalised
    return np.array([or_nan(e) for e in errors])
