"""Say what a diagnosis found, for the report, the workbench and the terminal."""

import math
from dataclasses import dataclass
from typing import Mapping, Sequence

from rovsim.dynamics.effects.base import Effect, StochasticCurrent
from rovsim.dynamics.effects.thruster_order import ThrusterOrder
from rovsim.dynamics.parameter_labels import label_parameter
from rovsim.reporting.wording import (
    ERROR_MEANING,
    ERROR_NAME,
    FLOOR_COUNTS_ALL,
    listed,
    percent,
    significant,
)
from rovsim.reporting.words.apart import apart_sentences, scale_sentences
from rovsim.reporting.words.intervals import interval
from rovsim.reporting.words.shown import shown_sentences
from rovsim.reporting.words.sureness import tell_sureness, unsure_sentences
from rovsim.reporting.words.symbols import Meaning, explain_symbols
from rovsim.reporting.words.unexplained import leaves_unexplained, unexplained_sentences
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis, times_above_floor
from rovsim.results.fitted import FittedEffect, FittedValue

VERDICT_SENTENCES = {
    "missing_effects": "The model lacks physics that the catalogue knows.",
    "adequate": "Nothing is missing: what is left is noise.",
    "unexplained": "Something is missing that the catalogue does not know.",
    "insufficient_data": "The recordings cannot tell: too short, or some axis never moved.",
}
LOST_SENTENCE = (
    "The recordings cannot tell: before they end the model runs away, although it is corrected at "
    "every reading."
)
NO_TEST_RUN = (
    "No test run could be used, so there is no error to report. Either no run of campaign.yaml has "
    "`split: test`, or those that have are too short or hardly move: see the report of "
    "`rovsim compare`."
)
NO_TRAIN_RUN = "Nothing could be judged: no train run could be used, and only those are looked at."
RUNS_AWAY = "The model cannot be judged: it runs away from the train runs."


@dataclass(frozen=True)
class Missing:
    """A selected effect in words; of one that is no longer in the catalogue, part is empty.

    Attributes:
        effect: its id.
        meaning: the first sentence of its description; this and the last three may be empty.
        parameters: each with its name, value and 95 % interval.
        worth: the share of the error that it removes, and how sure its name is.
        equation: in LaTeX.
        symbols: of the equation, with their meanings.
        cause: what usually makes it happen.
    """

    effect: str
    meaning: str
    parameters: tuple[str, ...]
    worth: str
    equation: str
    symbols: tuple[Meaning, ...]
    cause: str


@dataclass(frozen=True)
class Verdict:
    """A diagnosis in words.

    Attributes:
        name: of the verdict, as in diagnosis.json.
        sentence: that states it.
        missing: the selected effects.
        key: how to read these; empty where there is none.
        error: sentences on the error on the test runs.
        remarks: what else to know.
        next: what to record next; empty if nothing.
    """

    name: str
    sentence: str
    missing: tuple[Missing, ...]
    key: str
    error: str
    remarks: tuple[str, ...]
    next: str

    @property
    def sentences(self) -> tuple[str, ...]:
        """The sentences on the error, then the remarks."""
        return (self.error, *self.remarks)


def explain(diagnosis: Diagnosis, catalogue: Mapping[str, type[Effect]]) -> Verdict:
    """Say in words what a diagnosis found; the catalogue tells what its effects are."""
    remarks = [
        *unsure_sentences(diagnosis, catalogue),
        *apart_sentences(diagnosis),
        *scale_sentences(diagnosis.common_scale),
        *unexplained_sentences(diagnosis),
        *shown_sentences(diagnosis),
    ]
    missing = tuple(
        _missing(
            fit,
            catalogue.get(fit.effect),
            diagnosis.thrusters,
            tell_sureness(fit),
            above=bool(place),
        )
        for place, fit in enumerate(diagnosis.selected)
    )
    return Verdict(
        diagnosis.verdict,
        _sentence(diagnosis),
        missing,
        _key(len(missing)),
        error_sentence(diagnosis),
        tuple(remarks),
        diagnosis.next_experiment,
    )


def _sentence(diagnosis: Diagnosis) -> str:
    """Return the sentence of the verdict; where nothing could be judged, one that says why."""
    unjudged = diagnosis.verdict == "insufficient_data" and not diagnosis.ranking
    if unjudged and diagnosis.not_followed_from_s:
        return RUNS_AWAY
    if unjudged and diagnosis.looked_at is not None and not diagnosis.looked_at.of:
        return NO_TRAIN_RUN
    if diagnosis.verdict == "insufficient_data" and diagnosis.not_followed_from_s:
        return LOST_SENTENCE
    return VERDICT_SENTENCES[diagnosis.verdict]


def _key(effects: int) -> str:
    """Say how to read intervals, probabilities and shares of so many effects."""
    if not effects:
        return ""
    text = "± is the 95 % interval. The probability compares a name with those tried in its place."
    if effects == 1:
        return text
    return (
        f"{text} The effect that removes most of the error comes first, then the one that removes "
        "most of what is left, and so on; each share is of the model's error, and comes on top of "
        "those above it."
    )


def _missing(
    one: FittedEffect, cls: type[Effect] | None, thrusters: Sequence[str], sure: str, above: bool
) -> Missing:
    """Describe a selected effect.

    `cls` is its class, if it is in the catalogue, `sure` says how sure its name is, and `above`
    whether the error that it removes is beyond that of effects above it.
    """
    meaning = (cls.__doc__ or "").split("\n")[0] if cls else ""
    equation, cause = (cls.equation, cls.cause) if cls else ("", "")
    symbols = explain_symbols(cls, one.parameters) if cls else []
    values = tuple(
        f"{label_parameter(one.effect, name, thrusters)} {_value(one.effect, v, thrusters)}"
        for name, v in one.parameters.items()
    )
    removed = _removed(one.error_reduction, above)
    if cls and issubclass(cls, StochasticCurrent):
        removed = "cannot be foreseen"
    worth = f"{removed}, {sure}"
    return Missing(one.effect, meaning, values, worth, equation, tuple(symbols), cause)


def _value(effect: str, value: FittedValue, thrusters: Sequence[str]) -> str:
    """Return a value with its interval as text; an order of thrusters with their names."""
    if effect == ThrusterOrder.id:
        return ThrusterOrder.describe(or_nan(value.value), thrusters)
    return interval(value)


def _removed(share: float | None, above: bool) -> str:
    if share is not None and round(100 * share) < 0:
        return f"raises the error by {percent(-share)}"
    return (
        f"removes another {percent(share)}" if above else f"removes {percent(share)} of the error"
    )


def error_sentence(diagnosis: Diagnosis) -> str:
    """Say the error on the test runs without and with the effects, and the noise floor."""
    error = diagnosis.error
    before, after, floor = map(or_nan, (error.nominal, error.with_effects, error.noise_floor))
    if diagnosis.runs_away_in:
        return _divergence_sentence(diagnosis.runs_away_in, after)
    if not math.isfinite(before):
        return NO_TEST_RUN
    now = _change(before, after) if diagnosis.selected else f"is {significant(before)}"
    text = f"On the test runs the {ERROR_NAME} {now}."
    if not math.isfinite(floor):
        why = "not all that is left is noise, or only parts of the pose were measured"
        if not diagnosis.noise.disturbance:
            why = "nothing was learned of the noise of the train runs"
        text += f" What a perfect model would show cannot be estimated: {why}."
    elif leaves_unexplained(diagnosis):
        text += f" {FLOOR_COUNTS_ALL.format(significant(floor))}"
    else:
        text += f" A perfect model would show about {significant(floor)} (noise floor)."
        text += _compare_with_floor(diagnosis)
    return f"{text} {ERROR_MEANING}."


def _compare_with_floor(diagnosis: Diagnosis) -> str:
    """Say what an error above the noise floor means; nothing where it is near."""
    if times := times_above_floor(diagnosis.verdict, diagnosis.times_floor):
        return (
            f" The error is {significant(times, 2)} times that, also in windows that begin a "
            "second after the log or later, although nothing but noise is left in the train runs: "
            "the test runs differ from them."
        )
    if diagnosis.above_at_start:
        return (
            " What is above that is in windows that begin within a second of the log: nobody knows "
            "what the thrusters were told before."
        )
    return ""


def _change(before: float, after: float) -> str:
    """Say how an error changed, as far as its printed digits show it."""
    then, now = significant(before), significant(after)
    if then == now:
        return f"stays at {now}"
    return f"{'rises' if after > before else 'falls'} from {then} to {now}"


def _divergence_sentence(runs: Sequence[str], after: float) -> str:
    """Say that the model has no error, as it diverges in these test runs.

    `after` is the error of the model with effects, which may have one; NaN if not.
    """
    text = (
        f"The model has no error on the test runs: in {listed(runs)} it runs away within 2 s of "
        "the measured state. Usually its total drag on an axis is negative, or a value has the "
        "wrong sign."
    )
    if not math.isfinite(after):
        return text
    return f"{text} With the effects the {ERROR_NAME} is {significant(after)}. {ERROR_MEANING}."
