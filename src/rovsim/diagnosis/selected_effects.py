"""Which accepted effects are selected in the end, in what order, and which of them in doubt."""

from dataclasses import dataclass
from typing import Collection, Sequence

from rovsim.diagnosis.answer import SettledAnswer
from rovsim.diagnosis.equations.proposal import ProposedLaw
from rovsim.diagnosis.selection.accepted_effects import (
    AcceptedEffect,
    name_drift,
    name_smoothing,
    name_terms,
)
from rovsim.diagnosis.selection.beside_law import (
    doubt_beside_law,
    keep_beside_law,
    list_rivals_beside,
)
from rovsim.diagnosis.selection.ranking import OrderedEffect, order_accepted
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.selection.withdrawn_probability import (
    find_constant_heave,
    find_leading,
    find_negative,
    find_small,
    withdraw_probability,
)
from rovsim.diagnosis.uncertainty.identifiability import find_perhaps_absent
from rovsim.diagnosis.validated_search import ValidatedSearch
from rovsim.estimation.fit import Fit


@dataclass(frozen=True, eq=False)
class SelectedEffects:
    """The effects that a diagnosis selects.

    Attributes:
        selected: first the one that removes most error.
        replaced: ids of accepted effects that a proposed law does without.
        rivals: effects that could stand in the place of selected ones.
    """

    selected: Sequence[OrderedEffect]
    replaced: frozenset[str]
    rivals: Sequence[Rival]


def select_effects(
    validated: ValidatedSearch, answer: SettledAnswer, wide_fit: Fit, law: ProposedLaw | None
) -> SelectedEffects:
    """Select the accepted effects that a law leaves, in order.

    Args:
        validated: the search that accepted them.
        answer: its answer at its final values.
        wide_fit: the same with intervals for all that is unknown.
        law: for what the effects leave; None where there is none.
    """
    base, rivals = validated.problem.base, answer.selection.named_rivals
    accepted = [*list_camera_effects(validated), *name_terms(wide_fit, rivals)]
    effects = _doubt(accepted, law, validated, find_perhaps_absent(wide_fit))
    replaced = frozenset(e.term.id for e in accepted) - {e.term.id for e in effects}
    proposed = law if law and law.complete else None
    if proposed:
        rivals = list_rivals_beside(rivals, effects)
    effects += _name_drift(answer)
    selected = order_accepted(base, effects, validated.problem.usable.runs)
    if proposed and sum(s.error_reduction for s in selected) < 0.0:
        selected = []  # only beside the law are they no worse than the base
    left = proposed.left if proposed else answer.structures
    if proposed or left:
        removed_by_law = proposed.error_reduction if proposed else 0.0
        small = find_small(selected, left[0].share if left else 0.0, removed_by_law)
        selected = withdraw_probability(selected, small, "unexplained")
    return SelectedEffects(selected, replaced, rivals)


def list_camera_effects(validated: ValidatedSearch) -> list[AcceptedEffect]:
    """The filter of the cameras as an effect; empty where they do not smooth."""
    return [name_smoothing(validated.smoothing)] if validated.smoothing else []


def _name_drift(answer: SettledAnswer) -> list[AcceptedEffect]:
    """The wandering of the current as an effect, where it is sure."""
    if not answer.fit.noise.drift:
        return []
    drift = answer.bank.measure_drift(answer.fit.linearised.e, answer.fit.noise)
    return [name_drift(drift, answer.leaves_physics)] if drift.sure else []


def _doubt(
    accepted: Sequence[AcceptedEffect],
    law: ProposedLaw | None,
    validated: ValidatedSearch,
    perhaps_absent: Collection[str],
) -> list[AcceptedEffect]:
    """The effects that a law leaves, without a probability where there is a doubt.

    Args:
        accepted: the effects.
        law: for what they leave; None where there is none.
        validated: the search that accepted them.
        perhaps_absent: ids of those whose values may as well be those of their absence.
    """
    effects = withdraw_probability(accepted, perhaps_absent, "perhaps_absent")
    if law:
        beside_law = keep_beside_law if law.complete else doubt_beside_law
        effects = beside_law(effects, law.beside)
    if validated.smoothing:
        effects = withdraw_probability(effects, find_leading(effects), "looks_ahead")
    if validated.difference:
        effects = withdraw_probability(effects, {validated.difference.effect_id}, "differs")
    effects = withdraw_probability(effects, validated.feedback_only, "autopilot")
    effects = withdraw_probability(effects, validated.varying, "varies")
    negative = find_negative(effects, validated.problem.base.body)
    effects = withdraw_probability(effects, negative, "negative")
    if validated.problem.base.vehicle.floats:
        effects = withdraw_probability(effects, find_constant_heave(effects), "depth_at_rest")
    return effects
