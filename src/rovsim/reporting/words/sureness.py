"""Say how sure the name of an effect is, or why it has no probability, and which values are not."""

from typing import Mapping

from rovsim.core.normal import Z_95
from rovsim.dynamics.effects.base import Effect, StochasticCurrent
from rovsim.dynamics.effects.clocks import InputDelay
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.effects.thrusters import name_parameter
from rovsim.reporting.wording import IMPROBABLE, listed, tell_probability
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis, bound_unexplained
from rovsim.results.fitted import FittedEffect, FittedValue


def tell_sureness(
    one: FittedEffect, found: Diagnosis, catalogue: Mapping[str, type[Effect]]
) -> str:
    """Say the probability of a selected effect's name, or why none is given."""
    if one.probability is not None:
        return f"probability {tell_probability(one.probability)}"
    return f"no probability: {_say_why(one, found, catalogue.get(one.effect))}"


def unsure_sentences(found: Diagnosis, catalogue: Mapping[str, type[Effect]]) -> list[str]:
    """Say which effects surely act although some of their values may be those of no effect."""
    sentences = []
    for fit in found.selected:
        cls = catalogue.get(fit.effect)
        absence = {p.name: p.neutral_value for p in cls.parameters} if cls else {}
        unsure = [name for name, v in fit.parameters.items() if _holds(v, absence.get(name, 0.0))]
        if unsure and (fit.probability or 0.0) > 1.0 - IMPROBABLE:
            names = [name_parameter(fit.effect, name, found.thrusters) for name in unsure]
            values = dict.fromkeys(f"{absence.get(name, 0.0):g}" for name in unsure)
            hold = "intervals of {} hold" if len(names) > 1 else "interval of {} holds"
            sentences.append(
                f"{fit.effect} is sure, but not each of its values: the 95 % "
                f"{hold.format(listed(names))} {' or '.join(values)}, which changes nothing."
            )
    return sentences


def _holds(value: FittedValue, other: float) -> bool:
    """Whether a value's 95 % interval contains another; False where it has no interval."""
    return abs(or_nan(value.value) - other) <= Z_95 * or_nan(value.std)


def _say_why(one: FittedEffect, found: Diagnosis, known: type[Effect] | None) -> str:
    proposal = found.unexplained.proposal
    if known and issubclass(known, StochasticCurrent):
        return "what is left unexplained may seem a current that wanders"
    if proposal and one.effect not in {fit.effect for fit in proposal.beside}:
        return "the proposed equation does without it"
    if one.effect in found.unexplained.stand_ins:
        return "an equation that was tried takes most of its place"
    smooths = any(fit.effect == PoseFilter.id for fit in found.selected)
    if known and issubclass(known, InputDelay) and smooths and _leads(one):
        return "the cameras' filter may look ahead"
    reductions = [fit.error_reduction for fit in found.selected]
    unexplained = bound_unexplained(found.unexplained.fraction, reductions)
    if proposal is None and or_nan(one.error_reduction) < unexplained:
        return "what is left unexplained may make more of the error"
    return "no other name was tried"


def _leads(one: FittedEffect) -> bool:
    return any(or_nan(value.value) < 0.0 for value in one.parameters.values())
