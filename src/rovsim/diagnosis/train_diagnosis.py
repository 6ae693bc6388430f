"""Diagnose the train runs of a campaign: which effects a model lacks, and what is left.

step           where                                   what
filter bank    estimation/observer/filter_bank         the base runs along the train runs, corrected
camera         estimation/observer/camera              does software smooth what the cameras report?
sensitivities  estimation/sensitivities                how candidates would change the innovations
search         diagnosis/selection/forward_selection   add, refit, swap, prune; against chance
held out       diagnosis/selection/cross_validation    on blocks that an addition was not fitted to
few blocks     diagnosis/selection/cluster_robust      must not make it sure, without velocities
validation     diagnosis/selection/holdout_validation  replays of stretches that were kept apart
structure      diagnosis/structure/residual_structure  what is left, and no candidate explains
unnoticed      diagnosis/selection/forward_selection   then also those that nobody would notice
masked laws    diagnosis/equations/masked              do names stand in for a law like them?
joint fit      diagnosis/selection/joint_fit           all that could be wrong together; it competes
wandering      estimation/observer/drifting_current    if it is a matter of place: anew, without
between runs   diagnosis/checks/run_differences        has an effect another value in each run?
replay fit     estimation/replay_fit                   values that replay best, with structure left
whole file     diagnosis/uncertainty/file_values       all of a file that is off, where none is left
common scale   diagnosis/uncertainty/common_scale      does a factor of all forces stay open?
equation       diagnosis/equations/proposal            a law for what is left
disturbance    diagnosis/equations/disturbance         the force in time, where there is no law
test runs      diagnosis/campaign_diagnosis            opened once, for the errors that are reported
"""

from dataclasses import dataclass, replace
from typing import Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from rovsim.diagnosis.answer import SettledAnswer, finalise_answer, polish_selection
from rovsim.diagnosis.checks.commanded import list_not_commanded
from rovsim.diagnosis.checks.disturbed_ends import find_disturbed_ends
from rovsim.diagnosis.checks.observability import list_not_observable
from rovsim.diagnosis.checks.run_differences import RunDifference
from rovsim.diagnosis.equations.disturbance import ForceInTime, trace_force
from rovsim.diagnosis.equations.proposal import Catalogued, ProposedLaw, propose_law
from rovsim.diagnosis.selected_effects import list_camera_effects, select_effects
from rovsim.diagnosis.selection.ranking import OrderedEffect, RankedEffect, rank_alone
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.diagnosis.structure.residual import Structure
from rovsim.diagnosis.uncertainty.camera_delay import share_delay
from rovsim.diagnosis.uncertainty.common_scale import CommonScale
from rovsim.diagnosis.validated_search import (
    DiagnosisProblem,
    ValidatedSearch,
    search_and_validate,
)
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.uncertainty import correlate
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.divergence import ModelDiverged
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.usable_runs import UsableRuns, select_usable
from rovsim.results.diagnosis import DisturbedEnd, Verdict
from rovsim.results.fitted import Correlation


@dataclass(frozen=True, eq=False)
class TrainDiagnosis:
    """What was found on the train runs.

    Attributes:
        base: the model that was diagnosed.
        usable: the runs that could be used, and what was neither moved nor measured in them.
        fit: of the base and all selected effects; None where there was too little to judge.
        correlation: of the fitted values.
        selected: accepted effects, first the one that removes most error.
        ranking: every effect as the only addition to the base.
        rivals: effects that could stand in the place of selected ones.
        structures: what the remainder still depends on.
        refused: whether hold-out validation removed effects that explain something.
        scale: common factor of all forces and inertias; None where it is known.
        not_observable: ids of effects that the runs could not show.
        proposed: a law for what is left; None where no law holds.
        replaced: ids of accepted effects that the proposed law does without: they are not selected.
        disturbance: what is left as a force in time, where no law holds.
        difference: an effect that has another value in each run.
        disturbed_ends: of runs, which hold most of what is left.
    """

    base: Model
    usable: UsableRuns
    fit: Fit | None = None
    correlation: Correlation | None = None
    selected: Sequence[OrderedEffect] = ()
    ranking: Sequence[RankedEffect] = ()
    rivals: Sequence[Rival] = ()
    structures: Sequence[Structure] = ()
    refused: bool = False
    scale: CommonScale | None = None
    not_observable: Sequence[str] = ()
    proposed: ProposedLaw | None = None
    replaced: frozenset[str] = frozenset()
    disturbance: ForceInTime | None = None
    difference: RunDifference | None = None
    disturbed_ends: Sequence[DisturbedEnd] = ()

    @property
    def enough(self) -> bool:
        """Whether there was enough data to judge anything."""
        return self.fit is not None

    @property
    def verdict(self) -> Verdict:
        """The verdict, as `diagnosis.json` has it.

        `unexplained` where something is left but noise, or runs differ; else `missing_effects`
        where effects were selected; else `adequate`, unless an axis did not move or the model
        diverged in a run.
        """
        if not self.enough:
            return "insufficient_data"
        if self.structures or self.refused or self.difference:
            return "unexplained"
        if self.selected:
            return "missing_effects"
        unseen = self.usable.still or self.usable.diverged_from
        return "insufficient_data" if unseen else "adequate"

    @property
    def not_commanded(self) -> tuple[str, ...]:
        """Thrusters, surfaces or axes that these runs never commanded."""
        return list_not_commanded(self.usable, self.base.vehicle)

    def models(self) -> list[Model]:
        """The base, then models with one selected effect more each."""
        models = [self.base]
        for s in self.selected:
            models.append((models[-1] + s.term.effect).called(f"+{s.term.id}"))
        return models


def diagnose_train_runs(
    base: Model,
    train: Sequence[ObservedRun],
    settings: DiagnosisSettings,
    catalogue: Catalogue,
) -> TrainDiagnosis:
    """Find what a model lacks on the train runs of a campaign.

    A run in which the model diverges whatever the filter's corrections is only used up to there.

    Args:
        base: the model that is diagnosed.
        train: the train runs.
        settings: how the search decides, and how runs are filtered and replayed.
        catalogue: the effects that may be missing.
    """
    one_thread = threadpool_limits(1, "blas")  # matrices are too small for several to help
    # models may diverge during a search: they are refused for numbers that are not finite
    with one_thread, np.errstate(over="ignore", invalid="ignore"):
        usable = select_usable(train)
        while usable.enough:
            try:
                problem = DiagnosisProblem(base, usable, settings, catalogue)
                return _summarise(search_and_validate(problem))
            except ModelDiverged as diverged:
                runs, diverged_from = diverged.leave_out(usable.runs)
                usable = select_usable(runs, {**usable.diverged_from, **diverged_from})
        return TrainDiagnosis(base, usable)


def _summarise(validated: ValidatedSearch) -> TrainDiagnosis:
    """All that is reported of a validated search.

    These are the accepted effects with how sure they are, and a law or a force in time for what
    no effect describes.
    """
    base, usable = validated.problem.base, validated.problem.usable
    answer, wide_fit, scale = finalise_answer(validated.answer, usable.runs)
    if validated.smoothing:
        wide_fit, smoothing = share_delay(wide_fit, validated.smoothing)
        validated = replace(validated, smoothing=smoothing)
    seeks_law = answer.leaves_physics and validated.difference is None  # that follows no law
    law = _propose(answer, validated) if seeks_law else None
    effects = select_effects(validated, answer, wide_fit, law)
    start, proposed = validated.start, law if law and law.complete else None
    return TrainDiagnosis(
        base,
        usable,
        answer.fit,
        _correlate(wide_fit),
        effects.selected,
        ranking=rank_alone(start.workspace, start.base_fit, answer.fit),
        rivals=effects.rivals,
        structures=answer.structures,
        refused=answer.refused or not answer.fit.is_finite,
        scale=scale,
        not_observable=list_not_observable(
            answer.selection, validated.problem.catalogue, base.vehicle
        ),
        proposed=proposed,
        replaced=effects.replaced,
        disturbance=None if proposed else _trace(answer),
        difference=validated.difference,
        disturbed_ends=_find_ends(answer),
    )


def _correlate(fit: Fit) -> Correlation:
    """Correlation of the fitted values; empty where the fit has no finite covariance."""
    if not np.isfinite(fit.covariance).all():
        return Correlation()
    return correlate(fit.covariance, fit.hypothesis.parameter_names)


def _propose(answer: SettledAnswer, validated: ValidatedSearch) -> ProposedLaw | None:
    """A law for what the accepted effects leave; None where none holds."""
    base, runs, holdout = validated.problem.base, validated.problem.usable.runs, validated.holdout

    def polish(with_law: Fit) -> tuple[Fit, FilterBank]:
        return polish_selection(replace(answer.selection, best=with_law), runs)

    model = answer.fit.hypothesis.model
    catalogued = Catalogued(model, answer.replayed if holdout.runs else model)
    camera = list_camera_effects(validated)
    return propose_law(answer.selection, catalogued, base, holdout, runs, polish, camera)


def _find_ends(answer: SettledAnswer) -> Sequence[DisturbedEnd]:
    """Ends of runs that hold most of what is left; none where nothing is."""
    if not answer.structures or not answer.fit.is_finite:
        return ()
    return find_disturbed_ends(answer.fit, answer.bank)


def _trace(answer: SettledAnswer) -> ForceInTime | None:
    """The force in time that is left; None without a structure, or where the model diverges."""
    if not answer.structures or not answer.fit.is_finite:
        return None
    return trace_force(answer.fit, answer.bank, answer.structures)
