"""Say how sure the name of an effect is, or why it has no probability, and which values are not."""

from typing import Mapping

from rovsim.core.normal import Z_95
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.parameter_labels import label_parameter
from rovsim.reporting.wording import MIN_TOLD_PROBABILITY, listed, tell_probability
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.fitted import Doubt, FittedValue, SelectedEffect

DOUBT_REASONS: dict[Doubt | None, str] = {
    None: "no other name was tried",
    "stand_in": "an equation that was tried takes most of its place",
    "unexplained": "what is left unexplained may make more of the error",
    "wanders": "what is left unexplained may seem a current that wanders",
    "looks_ahead": "the cameras' filter may look ahead",
    "depth_at_rest": "if it floats at rest elsewhere than in the middle of its depths, that is "
    "the same force in heave",
    "differs": "runs differ in it, so that no value is right for all of them",
    "autopilot": "it only shows where an autopilot seems to know more than the cameras",
    "varies": "its value varies from run to run, and that of a property of the vehicle does not",
    "negative": "with it a coefficient falls below zero: water would push, or weigh less than "
    "nothing",
    "perhaps_absent": "as far as its values are known, they may be those of its absence",
}


def tell_sureness(one: SelectedEffect) -> str:
    """Say the probability of a selected effect's name, or why none is given."""
    if one.probability is not None:
        return f"probability {tell_probability(one.probability)}"
    return f"no probability: {DOUBT_REASONS[one.doubt]}"


def unsure_sentences(diagnosis: Diagnosis, catalogue: Mapping[str, type[Effect]]) -> list[str]:
    """Say which effects surely act although some of their values may be those of no effect."""
    sentences = []
    for fit in diagnosis.selected:
        cls = catalogue.get(fit.effect)
        absence = {p.name: p.neutral_value for p in cls.parameters} if cls else {}
        unsure = [name for name, v in fit.parameters.items() if _holds(v, absence.get(name, 0.0))]
        if unsure and (fit.probability or 0.0) > 1.0 - MIN_TOLD_PROBABILITY:
            names = [label_parameter(fit.effect, name, diagnosis.thrusters) for name in unsure]
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
