"""Withdraw the probability of accepted effects that may only stand in for something else.

An effect that is doubted for several reasons keeps the first.
"""

from dataclasses import replace
from typing import Collection, Iterable, Sequence, TypeVar

import numpy as np

from rovsim.diagnosis.selection.accepted_effects import AcceptedEffect
from rovsim.diagnosis.selection.ranking import OrderedEffect
from rovsim.dynamics.effects.buoyancy import NetBuoyancy
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.estimation.observer.hypothesis import Term
from rovsim.results.fitted import Doubt

CHANGED_SHARE = 0.5  # of an effect: more is not the same effect beside something else

E = TypeVar("E", bound=AcceptedEffect)


def withdraw_probability(effects: Iterable[E], doubted: Collection[str], doubt: Doubt) -> list[E]:
    """The same effects, without a probability for those whose ids are `doubted`."""
    return [
        replace(e, probability=None, doubt=e.doubt or doubt) if e.term.id in doubted else e
        for e in effects
    ]


def find_constant_heave(effects: Iterable[AcceptedEffect]) -> set[str]:
    """Ids of constant forces in heave, which only shift the depth at which a vehicle floats.

    That depth is the median of a run, so a pilot who pushes down for most of it shifts it as well.
    """
    constant = {NetBuoyancy.id: "force", ConstantWrench.id: "heave"}
    return {e.term.id for e in effects if constant.get(e.term.id) in e.term.free}


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
    remaining = max(0.0, 1.0 - sum(e.error_reduction for e in effects))
    bound = (fraction or 0.0) * remaining  # share of the base's error that is unexplained at most
    return {e.term.id for e in effects if e.error_reduction < bound}


def doubt_beside_law(
    effects: Sequence[AcceptedEffect], beside: Sequence[AcceptedEffect], proposed: bool
) -> list[AcceptedEffect]:
    """Withdraw what a law makes unnecessary, or changes by more than half.

    Args:
        effects: the accepted effects, fitted without the law.
        beside: the effects that are fitted together with the law.
        proposed: whether the law is proposed, or was only tried.
    """
    acting = {e.term.id: e.term for e in beside}
    idle = {e.term.id for e in effects if e.term.id not in acting}
    changed = {
        e.term.id for e in effects if e.term.id not in idle and _differs(e.term, acting[e.term.id])
    }
    effects = withdraw_probability(effects, idle, "law" if proposed else "stand_in")
    return withdraw_probability(effects, changed, "stand_in")


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
