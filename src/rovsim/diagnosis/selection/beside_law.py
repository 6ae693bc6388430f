"""What remains of the accepted effects beside a law for what they left."""

from dataclasses import replace
from typing import Iterable, Sequence

import numpy as np

from rovsim.diagnosis.selection.accepted_effects import AcceptedEffect
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.selection.withdrawn_probability import withdraw_probability
from rovsim.estimation.observer.hypothesis import Term

CHANGED_SHARE = 0.5  # of an effect: more is not the same effect beside something else

Pair = tuple[AcceptedEffect, AcceptedEffect]


def keep_beside_law(
    effects: Sequence[AcceptedEffect], beside: Iterable[AcceptedEffect]
) -> list[AcceptedEffect]:
    """The effects that act beside a law that is proposed, at the values that they have there.

    The law does without the others, and replays better than with them. One that it changes by more
    than half has no probability.

    Args:
        effects: the accepted effects, fitted without the law.
        beside: the effects that are fitted together with the law.
    """
    pairs = _pair(effects, beside)
    kept = [replace(alone, term=there.term, std=there.std) for alone, there in pairs]
    return withdraw_probability(kept, _find_changed(pairs), "stand_in")


def doubt_beside_law(
    effects: Sequence[AcceptedEffect], beside: Sequence[AcceptedEffect]
) -> list[AcceptedEffect]:
    """The same effects, without a probability where a law that was only tried replaces them.

    It makes an effect unnecessary, or changes it by more than half. The arguments are those of
    `keep_beside_law`.
    """
    pairs = _pair(effects, beside)
    idle = {e.term.id for e in effects} - {alone.term.id for alone, _ in pairs}
    return withdraw_probability(effects, idle | _find_changed(pairs), "stand_in")


def list_rivals_beside(rivals: Iterable[Rival], kept: Iterable[AcceptedEffect]) -> list[Rival]:
    """The rivals of effects that are kept beside a law; their fits were made without it."""
    ids = {e.term.id for e in kept}
    return [replace(r, fit=None) for r in rivals if r.instead_of in ids]


def _pair(effects: Iterable[AcceptedEffect], beside: Iterable[AcceptedEffect]) -> list[Pair]:
    """Each effect that acts beside the law as well: as it is without the law, and with it."""
    acting = {e.term.id: e for e in beside}
    return [(e, acting[e.term.id]) for e in effects if e.term.id in acting]


def _find_changed(pairs: Iterable[Pair]) -> set[str]:
    return {alone.term.id for alone, there in pairs if _differs(alone.term, there.term)}


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
