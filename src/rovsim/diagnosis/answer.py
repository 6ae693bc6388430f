"""An answer: the accepted effects, validated, at their final values, and what they leave."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Sequence

from rovsim.diagnosis.checks.unlogged_effects import drop_unlogged
from rovsim.diagnosis.selection.cluster_robust import drop_unsure
from rovsim.diagnosis.selection.cross_validation import drop_idle
from rovsim.diagnosis.selection.forward_selection import search_unnoticed
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.vehicle_file.steps import without_gain
from rovsim.diagnosis.selection.vehicle_file.whole_file import fit_whole_file, sharpen_covariance
from rovsim.diagnosis.structure.residual import Structure
from rovsim.diagnosis.structure.residual_structure import find_structure
from rovsim.diagnosis.uncertainty.common_scale import CommonScale
from rovsim.diagnosis.uncertainty.file_values import is_right_elsewhere, settle_whole_file
from rovsim.diagnosis.uncertainty.identifiability import find_doubtful
from rovsim.diagnosis.uncertainty.rest_of_file import include_rest
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit, fit_noise_only, polish
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.usable_runs import UsableRuns
from rovsim.estimation.replay_fit import fit_to_replays


@dataclass(frozen=True, eq=False)
class SettledAnswer:
    """The accepted effects at their final values, and all that they leave unexplained.

    Attributes:
        selection: the search, with the effects that hold-out validation let pass.
        fit: of these effects to all train runs.
        bank: the filters of that fit.
        score: its 2 log L, less the penalty of the free parameters.
        structures: what the innovations still depend on, by more than chance.
        refused: hold-out validation removed effects, and no other effect explains what they did.
        whole_file_fit: where the vehicle file is loose, a fit in which all that the file states is
            free as well; `structures` are then those that this fit leaves.
    """

    selection: SearchResult
    fit: Fit
    bank: FilterBank
    score: float
    structures: Sequence[Structure]
    refused: bool = False
    whole_file_fit: Fit | None = None

    @property
    def complete(self) -> bool:
        """Whether nothing but noise is left."""
        return self.fit.is_finite and not (self.structures or self.refused)

    @property
    def leaves_physics(self) -> bool:
        """Whether more is left than single pushes: physics that no accepted effect describes.

        An accepted effect may then only stand in for part of that physics.
        """
        momentary = all(s.moment for s in self.structures)
        return self.refused or not (self.fit.is_finite and momentary)

    @cached_property
    def replayed(self) -> Model:
        """The model at the values that replay best, of the stretches the search was made on."""
        fit = self.selection.best
        if len(fit.hypothesis.x):
            fit = _refit_to_replays(fit, self.selection.workspace.bank)
        return fit.hypothesis.model


def settle_noticed(
    selection: SearchResult, usable: UsableRuns, holdout: HoldoutValidation, seed: int
) -> SettledAnswer:
    """Settle the effects that a user would notice; where those leave physics, the others as well.

    An effect goes unnoticed if it hardly changes the error of windows of 2 s. Such effects are only
    accepted where, together with them, nothing but noise is left. A search that was stopped left
    more than they could explain.

    Args:
        selection: where the search ended.
        usable: the train runs.
        holdout: the stretches of them that took no part in the search.
        seed: of the draws that tell what chance explains.
    """
    noticed = drop_unlogged(drop_idle(drop_unsure(selection)))
    answer = settle(noticed, usable, holdout)
    if selection.stopped or not answer.leaves_physics:
        return answer
    unfiltered = drop_unlogged(drop_unsure(search_unnoticed(selection, seed)))
    if unfiltered.best is noticed.best:
        return answer
    alternative = settle(unfiltered, usable, holdout)
    return alternative if alternative.complete else answer


def settle(
    selection: SearchResult, usable: UsableRuns, holdout: HoldoutValidation
) -> SettledAnswer:
    """Validate a selection on the held-out stretches, and fit what passes to all train runs."""
    selection, unchanged = holdout.validate(selection)
    settled = _settle_values(selection, usable)
    if settled.leaves_physics:
        pruned = holdout.keep_earning(selection)
        if pruned.best is not selection.best:
            settled = _keep_structures(_settle_values(pruned, usable), settled)
        settled = _keep_file_gain(settled, usable, holdout)
    return replace(settled, refused=not unchanged and settled.complete)


def _keep_structures(fewer: SettledAnswer, more: SettledAnswer) -> SettledAnswer:
    """An answer with fewer effects, and with what is left beside more of them.

    Where fewer effects are less likely and yet seem to leave nothing, it is in their disturbance.
    """
    if fewer.structures or fewer.score >= more.score:
        return fewer
    return replace(fewer, structures=more.structures)


def _keep_file_gain(
    settled: SettledAnswer, usable: UsableRuns, holdout: HoldoutValidation
) -> SettledAnswer:
    """The answer with the file's gain of the thrusters, unless another surely replays better.

    Where the file is loose, a factor of all forces and inertias is nearly free. Beside unknown
    physics the likelihood does not fix it: a gain of 1.71 +- 0.01 was fitted for one of 1.04.
    """
    selection = settled.selection
    fit = without_gain(selection.workspace, selection.best)
    if fit is None or not fit.is_finite:
        return settled
    other = _settle_values(replace(selection, best=fit), usable)
    if not other.fit.is_finite or _replays_better(settled, other, holdout):
        return settled
    return _keep_structures(other, settled)


def _settle_values(selection: SearchResult, usable: UsableRuns) -> SettledAnswer:
    """Fit a selection to all train runs, without effects that are not worth their penalty there."""
    fit, bank = polish_selection(selection, usable.runs)
    pruned_fit = selection.prune(selection.workspace.on_runs(bank, fit.noise), fit)
    if pruned_fit is not fit:
        pruned = selection.fit(pruned_fit.hypothesis)
        if pruned.is_finite:
            return _settle_values(replace(selection, best=pruned), usable)
    score = selection.workspace.score(fit)
    whole_file_fit = fit_whole_file(fit.hypothesis, bank, fit.noise)
    structures = (
        find_structure(fit if whole_file_fit is None else whole_file_fit, bank)
        if fit.is_finite
        else []
    )
    return SettledAnswer(selection, fit, bank, score, structures, whole_file_fit=whole_file_fit)


def settle_without(
    answer: SettledAnswer, effect_id: str, usable: UsableRuns
) -> SettledAnswer | None:
    """An answer without an effect, which is not blamed for the structure that this leaves.

    None where the model diverges without it.
    """
    selection = answer.selection.without_effect(effect_id)
    if selection is None:
        return None
    reduced = _settle_values(selection, usable)
    return replace(reduced, structures=answer.structures) if reduced.fit.is_finite else None


def _replays_better(
    one: SettledAnswer, other: SettledAnswer, holdout: HoldoutValidation
) -> bool | None:
    """Whether one answer surely replays the held-out stretches better; None where neither does."""
    return holdout.prefers(one.replayed, other.replayed) if holdout.runs else None


def choose_answer(
    one: SettledAnswer, other: SettledAnswer, holdout: HoldoutValidation
) -> SettledAnswer:
    """Choose the answer that surely replays better; else the complete or the likelier one.

    The likelihood alone cannot choose: where an answer is not complete, it takes physics for noise.
    So both answers first replay the held-out stretches, each at the values that replay the other
    stretches best. If that does not decide, they replay every run, each time at the values that
    replay the other runs best.
    """
    prefers_one = _replays_better(one, other, holdout)
    if prefers_one is None:
        prefers_one = holdout.prefers_between_runs(one.fit, other.fit)
    if prefers_one is not None:
        return one if prefers_one else other
    return one if not other.complete and one.score >= other.score else other


class FinalAnswer(NamedTuple):
    """An answer as it is reported.

    Attributes:
        answer: at the values that are reported.
        fit: the same values, with intervals that include what the runs cannot know.
        scale: the factor common to all forces and inertias, where the runs leave it open.
    """

    answer: SettledAnswer
    fit: Fit
    scale: CommonScale | None


def finalise_answer(answer: SettledAnswer, runs: Sequence[ObservedRun]) -> FinalAnswer:
    """Give an answer the values and the intervals that are reported.

    Where physics is left that no effect describes, a likelihood would be misled by it, so the
    values that replay best are reported. Else the intervals are widened by what else may be wrong:
    the rest of the vehicle file, or the factor common to all forces and inertias.

    Args:
        answer: the answer.
        runs: all train runs, which it was fitted to.
    """
    if answer.leaves_physics and len(answer.fit.hypothesis.x):
        answer = replace(answer, fit=_refit_to_replays(answer.fit, answer.bank))
    whole_file_fit, selected = answer.whole_file_fit, answer.fit.hypothesis
    if answer.leaves_physics or whole_file_fit is None:
        return FinalAnswer(answer, *include_rest(answer.fit, runs, has_loose_file(selected)))
    whole_file_fit = sharpen_covariance(whole_file_fit, selected, answer.bank)
    if is_right_elsewhere(whole_file_fit, selected):
        return FinalAnswer(answer, *include_rest(answer.fit, runs, loose=False))
    final, scale = settle_whole_file(whole_file_fit, selected, answer.bank)
    return FinalAnswer(replace(answer, fit=final), final, scale)


def _refit_to_replays(fit: Fit, bank: FilterBank) -> Fit:
    """Fit to replays, without effects whose values may then as well be those of their absence."""
    refit = fit_to_replays(fit, bank)
    while len(refit.hypothesis.terms) > 1:
        doubtful = find_doubtful(refit)
        if doubtful is None:
            break
        linearised = bank.linearise(refit.hypothesis.without(doubtful))
        refit = fit_to_replays(fit_noise_only(linearised, bank, fit.noise), bank)
    return refit


def polish_selection(
    selection: SearchResult, runs: Sequence[ObservedRun]
) -> tuple[Fit, FilterBank]:
    """Fit a selection to all train runs, with the noise and the filters that suit it.

    Returns:
        The fit, and the filters that it was made with.
    """
    return polish(selection.best, runs, selection.prior_std)
