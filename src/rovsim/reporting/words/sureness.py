"""How sure a name is, and why no probability is given where none is."""

from typing import Mapping

from rovsim.dynamics.effects.base import Effect, Wander
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.reporting.wording import tell_probability
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import FittedEffect


def tell_sureness(
    one: FittedEffect, found: Diagnosis, catalogue: Mapping[str, type[Effect]]
) -> str:
    """The probability of a selected effect's name, or what speaks against giving one."""
    if one.probability is not None:
        return f"probability {tell_probability(one.probability)}"
    return f"no probability: {_say_why(one, found, catalogue.get(one.effect))}"


def _say_why(one: FittedEffect, found: Diagnosis, known: type[Effect] | None) -> str:
    proposal = found.unexplained.proposal
    if known and issubclass(known, Wander):
        return "what is left unexplained may seem a current that wanders"
    if proposal and one.effect not in {each.effect for each in proposal.beside}:
        return "the proposed equation does without it"
    if one.effect in found.unexplained.stand_ins:
        return "an equation that was tried takes most of its place"
    smooths = any(each.effect == PoseFilter.id for each in found.selected)
    if known and issubclass(known, InputDelay) and smooths and _leads(one):
        return "the cameras' filter may look ahead"
    return "no other name was tried"


def _leads(one: FittedEffect) -> bool:
    return any(or_nan(value.value) < 0.0 for value in one.parameters.values())
