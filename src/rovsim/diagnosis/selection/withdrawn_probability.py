"""Withdraw the probability of accepted effects that may only stand in for something else.

An effect that is doubted for several reasons keeps the first.
"""

from dataclasses import replace
from typing import Collection, Iterable, Sequence, TypeVar

import numpy as np

from rovsim.core.axes import AXES
from rovsim.diagnosis.selection.accepted_effects import AcceptedEffect
from rovsim.diagnosis.selection.ranking import OrderedEffect
from rovsim.dynamics.body import Body
from rovsim.dynamics.effects.buoyancy import NetBuoyancy
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.results.fitted import Doubt

E = TypeVar("E", bound=AcceptedEffect)
SURELY_STDS = 3.0  # standard deviations: one coefficient in 700 is so far off by chance


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


def find_negative(effects: Iterable[AcceptedEffect], body: Body) -> set[str]:
    """Ids of effects by which a coefficient of drag or added mass surely falls below zero.

    Water that pushes, or that weighs less than nothing, is not there: the value is that of
    something else.

    Args:
        effects: the accepted effects.
        body: of the base, with what its file states.
    """
    found = set()
    for one in effects:
        stated = dict(zip(AXES, body.stated.get(one.term.id, ()), strict=False))
        total = {n: stated[n] + one.term.effect[n] for n in one.term.free if n in stated}
        if any(total[n] < -SURELY_STDS * one.std.get(n, np.inf) for n in total):
            found.add(one.term.id)
    return found


def find_small(
    effects: Sequence[OrderedEffect], fraction: float, removed_by_law: float
) -> set[str]:
    """Ids of effects that may be smaller than what the catalogue does not name.

    Likelihoods weigh effects rightly only where all else is noise. Beside unknown physics they
    favour the effect that happens to resemble it a little, and a law that was found for it need not
    be its own. What one effect raises first, another does not remove: two that cancel one another
    are judged by their sum. One that is tried and not fitted, such as two swapped thrusters, has no
    value that could show how far it is only like that physics: it is listed whatever it removes.

    Args:
        effects: the accepted effects.
        fraction: share of the remaining disturbance's power that follows the largest structure; 0
            without one.
        removed_by_law: share of the base's error that a law removes in addition; 0 without one.
    """
    remaining = max(0.0, 1.0 - removed_by_law - sum(e.error_reduction for e in effects))
    bound = removed_by_law + fraction * remaining  # share of the base's error, at most
    raised = sum(min(0.0, e.error_reduction) for e in effects)
    return {e.term.id for e in effects if e.error_reduction + raised < bound or not e.term.free}
