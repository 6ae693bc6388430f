"""Assemble the content of `diagnosis.json`: what was found on the train runs, and its context."""

from dataclasses import dataclass, field
from typing import Mapping, Sequence

import numpy as np

from rovsim.core.odds import share_odds
from rovsim.core.rounding import rounded, rounded_or_none
from rovsim.diagnosis.advice import advise
from rovsim.diagnosis.differing_runs import HeldOutRuns
from rovsim.diagnosis.fitted_values import describe_values
from rovsim.diagnosis.selection.accepted_effects import find_std
from rovsim.diagnosis.selection.ranking import OrderedEffect, RankedEffect
from rovsim.diagnosis.selection.search_result import MIN_LR_APART, Rival
from rovsim.diagnosis.train_diagnosis import TrainDiagnosis
from rovsim.diagnosis.uncertainty.common_scale import CommonScale
from rovsim.diagnosis.uncertainty.identifiability import group_connected, group_joint_parameters
from rovsim.diagnosis.unexplained import describe_unexplained
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model_file import describe_model
from rovsim.dynamics.uncertainty import correlate
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term
from rovsim.results.diagnosis import (
    Diagnosis,
    DiagnosisErrors,
    LookedAt,
    RivalEffect,
    ScaleOfForces,
    Standstill,
    times_above_floor,
)
from rovsim.results.error_conditions import ConditionShare
from rovsim.results.fitted import (
    Correlation,
    FittedEffect,
    FittedNoise,
    Possibility,
    Posterior,
    SelectedEffect,
)
from rovsim.results.ladder import Ladder

MIN_LISTED_EFFECTS = 10  # of the ranking; those selected are listed in any case


@dataclass(frozen=True, eq=False)
class CampaignContext:
    """What is reported beside the diagnosis of the train runs.

    Attributes:
        recordings: digests of the files that the runs were read from, by path.
        where: conditions under which the base fails.
        ladder: errors on the test runs: of the base, with one effect more each, and of a perfect
            model.
        looked_at: how much of the train runs was used.
        standstills: stretches of train runs in which the vehicle stands still although the base
            would move.
        diverges_in: ids of the test runs in which the base diverges.
        unlogged: by train run, how many s are not used as nobody knows what was commanded.
        times_floor: see `Diagnosis`.
        late_tests: see `HeldOutRuns`.
    """

    recordings: Mapping[str, str]
    where: Sequence[ConditionShare]
    ladder: Ladder
    looked_at: LookedAt | None = None
    standstills: Sequence[Standstill] = ()
    diverges_in: Sequence[str] = ()
    unlogged: Mapping[str, float] = field(default_factory=dict)
    times_floor: float | None = None
    late_tests: Mapping[str, float] = field(default_factory=dict)


def assemble_diagnosis(
    diagnosis: TrainDiagnosis, context: CampaignContext, catalogue: Catalogue
) -> Diagnosis:
    """Assemble the content of `diagnosis.json`.

    It includes the model that was diagnosed, so that `rovsim add` needs no other file.

    Args:
        diagnosis: of the train runs.
        context: what else is reported.
        catalogue: says what reveals each effect.
    """
    groups = group_indistinguishable(diagnosis.rivals)
    joint = _list_joint(diagnosis)
    error = _summarise_errors(context.ladder, len(diagnosis.selected))
    times = times_above_floor(diagnosis.verdict, context.times_floor)
    test_runs = HeldOutRuns(times is not None, context.late_tests)
    return Diagnosis(
        verdict=diagnosis.verdict,
        selected=tuple(map(_describe_selected, diagnosis.selected)),
        ranking=tuple(map(_describe_ranked, _list_ranking(diagnosis))),
        indistinguishable=tuple(map(tuple, groups)),
        known_together=tuple(map(tuple, joint)),
        common_scale=_say_scale(diagnosis.scale),
        where=tuple(context.where),
        unexplained=describe_unexplained(diagnosis, times),
        next_experiment=advise(diagnosis, groups, joint, catalogue, test_runs),
        error=error,
        times_floor=rounded_or_none(context.times_floor),
        not_excited=diagnosis.usable.still,
        not_measured=diagnosis.usable.unmeasured,
        not_commanded=diagnosis.not_commanded,
        not_observable=tuple(diagnosis.not_observable),
        rivals=tuple(
            RivalEffect(
                effect=r.effect,
                instead_of=r.instead_of,
                deficit=rounded_or_none(r.deviance_difference),
            )
            for r in diagnosis.rivals
            if np.isfinite(r.deviance_difference)
        ),
        noise=_describe_noise(diagnosis),
        posterior=_describe_posterior(diagnosis),
        looked_at=context.looked_at,
        not_followed_from_s={
            run: round(at, 1) for run, at in diagnosis.usable.diverged_from.items()
        },
        runs_away_in=tuple(context.diverges_in),
        standstills=tuple(context.standstills),
        disturbed_ends=tuple(diagnosis.disturbed_ends),
        unlogged_s={run: round(seconds, 1) for run, seconds in context.unlogged.items()},
        thrusters=diagnosis.base.vehicle.thruster_names,
        recordings=dict(context.recordings),
        base=describe_model(diagnosis.base),
        ladder=context.ladder,
    )


def _list_joint(diagnosis: TrainDiagnosis) -> list[list[str]]:
    """Group parameters that are only known together, unless just the common scale relates them."""
    if diagnosis.fit is None:
        return []
    scaled = set(diagnosis.scale.parameters) if diagnosis.scale else set()
    groups = [g for g in group_joint_parameters(diagnosis.fit) if len(set(g) - scaled) > 1]
    return [g for g in groups if not {name.partition(".")[0] for name in g} & diagnosis.replaced]


def _say_scale(scale: CommonScale | None) -> ScaleOfForces | None:
    """Report the common scale of all forces, where it is unknown."""
    if scale is None:
        return None
    return ScaleOfForces(std=rounded_or_none(scale.std), parameters=scale.parameters)


def _summarise_errors(ladder: Ladder, selected: int) -> DiagnosisErrors:
    """Normalised errors in windows of 2 s (docs/signals.md); None where no test run can be scored.

    Args:
        ladder: of the test runs.
        selected: number of selected effects.
    """
    errors = [rounded_or_none(step.windows_2s) for step in ladder.models]
    return DiagnosisErrors(
        nominal=errors[0],
        with_effects=errors[selected],
        noise_floor=rounded_or_none(ladder.noise_floor),
    )


def _describe_selected(one: OrderedEffect) -> SelectedEffect:
    """Report an accepted effect."""
    return SelectedEffect(
        effect=one.term.id,
        parameters=describe_values(one.term, one.std),
        error_reduction=rounded_or_none(one.error_reduction),
        probability=rounded_or_none(one.probability),
        doubt=one.doubt,
    )


def _describe_ranked(one: RankedEffect) -> FittedEffect:
    """Report an effect of the ranking; its values are first estimates, without deviations."""
    return FittedEffect(
        effect=one.term.id,
        parameters=describe_values(one.term, {}),
        error_reduction=rounded_or_none(one.error_reduction),
        probability=rounded_or_none(one.probability),
    )


def _list_ranking(diagnosis: TrainDiagnosis) -> list[RankedEffect]:
    """List the first effects of the ranking, and the selected ones wherever they stand in it."""
    selected_ids = {s.term.id for s in diagnosis.selected}
    return [
        r
        for k, r in enumerate(diagnosis.ranking)
        if k < MIN_LISTED_EFFECTS or r.term.id in selected_ids
    ]


def group_indistinguishable(rivals: Sequence[Rival]) -> list[list[str]]:
    """Group effects that explain the runs about equally well.

    Groups that share an effect are one.
    """
    pairs = [(r.effect, r.instead_of) for r in rivals if r.deviance_difference < MIN_LR_APART]
    names = sorted({name for pair in pairs for name in pair})
    adjacency = np.zeros((len(names), len(names)), bool)
    for a, b in pairs:
        adjacency[names.index(a), names.index(b)] = True
    return sorted([names[k] for k in group] for group in group_connected(adjacency))


def _describe_posterior(diagnosis: TrainDiagnosis) -> Posterior | None:
    """Report how the values are correlated, and which rivals may act instead, by their odds.

    Nothing is known of them where some of the effects that were fitted are not selected.
    """
    selected_ids = {s.term.id for s in diagnosis.selected}
    if diagnosis.fit is None or {t.id for t in diagnosis.fit.hypothesis.terms} - selected_ids:
        return None
    close_rivals = [
        (r, r.fit)
        for r in diagnosis.rivals
        if r.deviance_difference < MIN_LR_APART and r.fit is not None
    ]
    _, *odds = share_odds([0.0, *(-r.deviance_difference for r, _ in close_rivals)])
    return Posterior(
        correlation=diagnosis.correlation or Correlation(),
        instead=tuple(
            Possibility(
                probability=rounded(probability),
                effects=_list_effects(fit),
                correlation=correlate(fit.covariance, fit.hypothesis.parameter_names),
            )
            for probability, (_, fit) in zip(odds, close_rivals, strict=True)
        ),
    )


def _list_effects(fit: Fit) -> tuple[FittedEffect, ...]:
    """List all effects of a fit that are not part of the vehicle itself."""
    h = fit.hypothesis
    pairs: list[tuple[Term, dict[str, float]]] = [(Term(effect, ()), {}) for effect in h.base.added]
    pairs += [(term, find_std(fit, i)) for i, term in enumerate(h.terms)]
    return tuple(
        FittedEffect(effect=term.id, parameters=describe_values(term, std)) for term, std in pairs
    )


def _describe_noise(diagnosis: TrainDiagnosis) -> FittedNoise:
    """Report the noise of the fit: the disturbance on each axis, and the errors of the readings."""
    if diagnosis.fit is None:
        return FittedNoise()
    noise = diagnosis.fit.noise
    slow = noise.bias_std.any()
    return FittedNoise(
        disturbance=tuple(map(rounded_or_none, noise.disturbance_std)),
        memory_s=tuple(map(rounded_or_none, noise.correlation_time)),
        reading=tuple(map(rounded_or_none, noise.measurement_std)),
        period_s=rounded_or_none(diagnosis.usable.runs[0].period),
        colour=tuple(map(rounded_or_none, noise.bias_std)) if slow else (),
        colour_memory_s=tuple(map(rounded_or_none, noise.bias_correlation_time)) if slow else (),
    )
