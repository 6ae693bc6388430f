"""Withdraw the probability of accepted effects that may only stand in for something else."""

from dataclasses import replace
from typing import Collection, Iterable, Sequence, TypeVar

import numpy as np

from rovsim.diagnosis.selection.accepted_effects import AcceptedEffect
from rovsim.diagnosis.selection.ranking import OrderedEffect
from rovsim.estimation.observer.hypothesis import Term
from rovsim.results.diagnosis import bound_unexplained

CHANGED_SHARE = 0.5  # of an effect: more is not the same effect beside something else

E = TypeVar("E", bound=AcceptedEffect)


def withdraw_probability(effects: Iterable[E], doubted: Collection[str]) -> list[E]:
    """The same effects, without a probability for those whose ids are `doubted`."""
    return [replace(e, probability=None) if e.term.id in doubted else e for e in effects]


def find_leading(effects: Iterable[AcceptedEffect]) -> set[str]:
    """Ids of negative delays, which are doubtful where the cameras smooth.

    Their filter may use later frames as well, and such a filter was not among the rivals.
    """
    return {e.term.id for e in effects if e.leads}


def find_small(effects: Sequence[OrderedEffect], fraction: float | None) -> set[str]:
    """Ids of effects that remove less error than what is left causes.

    Likelihoods weigh effects rightly only where all else is noise. Where unknown physics is left,
    they favour the effect that happens to resemble it a little.

    Args:
        effects: the accepted effects.
        fraction: share of the remaining disturbance's power that follows the largest structure.
    """
    bound = bound_unexplained(fraction, [e.error_reduction for e in effects])
    return {e.term.id for e in effects if e.error_reduction < bound}


def find_stand_ins(effects: Sequence[AcceptedEffect], beside: Sequence[AcceptedEffect]) -> set[str]:
    """Ids of effects that a law makes unnecessary, or changes by more than half.

    Args:
        effects: the accepted effects, fitted without the law.
        beside: the effects that are fitted together with the law.
    """
    acting = {e.term.id: e.term for e in beside}
    return {
        e.term.id for e in effects if e.term.id not in acting or _differs(e.term, acting[e.term.id])
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
