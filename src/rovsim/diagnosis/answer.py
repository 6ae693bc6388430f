"""An answer: what the search selected, validated, at its final values, and what it leaves."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Sequence

from rovsim.diagnosis.selection.cluster_robust import drop_unsure
from rovsim.diagnosis.selection.cross_validation import drop_idle
from rovsim.diagnosis.selection.forward_selection import search_unnoticed
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.vehicle_file.whole_file import fit_whole_file
from rovsim.diagnosis.structure.residual import Structure
from rovsim.diagnosis.structure.residual_structure import find_structure
from rovsim.diagnosis.uncertainty.common_scale import CommonScale, include_scale
from rovsim.diagnosis.uncertainty.file_values import is_right_elsewhere, settle_whole_file
from rovsim.diagnosis.uncertainty.identifiability import find_doubtful
from rovsim.diagnosis.uncertainty.rest_of_file import include_rest
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit, judge, polish
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.usable_runs import UsableRuns
from rovsim.estimation.replay_fit import fit_to_replays


@dataclass(frozen=True, eq=False)
class SettledAnswer:
    """An answer: its final values, how likely it is, and all that it leaves unexplained.

    `refused`: hold-out validation refused effects, and nothing else explains what these did.
    `whole`: the same with all of a vehicle file that is off, by which what is left is judged.
    """

    selection: SearchResult
    fit: Fit
    bank: FilterBank
    score: float
    structures: Sequence[Structure]
    refused: bool = False
    whole: Fit | None = None

    @property
    def size(self) -> int:
        """How many numbers were fitted."""
        return len(self.fit.hypothesis.x)

    @property
    def complete(self) -> bool:
        """Whether it leaves nothing."""
        return self.fit.is_finite and not (self.structures or self.refused)

    @property
    def lasting(self) -> bool:
        """Whether more is left than single pushes: then names may stand for what has none."""
        single = all(one.moment for one in self.structures)
        return self.refused or not (self.fit.is_finite and single)

    @cached_property
    def replayed(self) -> Model:
        """At the values that replay the stretches best that it was chosen by."""
        fit = self.selection.best
        if len(fit.hypothesis.x):
            fit = _refit_to_replays(fit, self.selection.workspace.bank)
        return fit.hypothesis.model


def settle_noticed(
    selection: SearchResult, usable: UsableRuns, holdout: HoldoutValidation, seed: int
) -> SettledAnswer:
    """Names that a user would notice; where they leave something, the others too if they do not."""
    noticed = drop_idle(drop_unsure(selection))
    answer = settle(noticed, usable, holdout)
    if not answer.lasting:
        return answer
    every = drop_unsure(search_unnoticed(selection, seed))
    if every.best is noticed.best:
        return answer
    more = settle(every, usable, holdout)
    return more if more.complete else answer


def settle(
    selection: SearchResult, usable: UsableRuns, holdout: HoldoutValidation
) -> SettledAnswer:
    """What hold-out validation passes, at its final values on all runs, and what it leaves."""
    selection, whole = holdout.judge(selection)
    settled = _settle_values(selection, usable)
    fewer = holdout.keep_earning(selection) if settled.lasting else selection
    if fewer.best is not selection.best:
        settled = _settle_values(fewer, usable)
    return replace(settled, refused=not whole and settled.complete)


def _settle_values(selection: SearchResult, usable: UsableRuns) -> SettledAnswer:
    """At its final values on all runs, without what these do not bear out."""
    fit, bank = polish_selection(selection, usable.runs)
    borne_out = selection.prune(selection.workspace.on_runs(bank, fit.noise), fit)
    if borne_out is not fit:
        fewer = selection.fit(borne_out.hypothesis)
        if fewer.is_finite:
            return _settle_values(replace(selection, best=fewer), usable)
    score = selection.workspace.score(fit)
    whole = fit_whole_file(fit.hypothesis, bank, fit.noise)
    left = find_structure(fit if whole is None else whole, bank) if fit.is_finite else []
    return SettledAnswer(selection, fit, bank, score, left, whole=whole)


def choose(one: SettledAnswer, other: SettledAnswer, holdout: HoldoutValidation) -> SettledAnswer:
    """Of two answers the one that surely replays better; else what is complete, or the smaller.

    Where an answer is not complete, what its likelihood takes for noise is physics, and so says
    little. So each replays stretches that took no part, at the values that replay the others best,
    as it would end; where these do not tell, each run at the values that replay the other runs
    best.
    """
    better = holdout.prefers(one.replayed, other.replayed) if holdout.runs else None
    if better is None:
        better = holdout.prefers_between_runs(one.fit, other.fit)
    if better is not None:
        return one if better else other
    return other if other.complete else min(one, other, key=lambda a: (a.size, -a.score))


def finish(
    answer: SettledAnswer, runs: Sequence[ObservedRun]
) -> tuple[SettledAnswer, Fit, CommonScale | None]:
    """At its final values; the fit with intervals that hold all that is not known, and the scale.

    Args:
        answer: the answer.
        runs: all that it was fitted to.
    """
    if answer.lasting and answer.size:
        answer = replace(answer, fit=_refit_to_replays(answer.fit, answer.bank))
    if answer.lasting or answer.whole is None:
        return answer, *include_rest(answer.fit, runs)
    if is_right_elsewhere(answer.whole, answer.fit.hypothesis):
        return answer, *include_scale(answer.fit, runs)
    final, scale = settle_whole_file(answer.whole, answer.fit.hypothesis, answer.bank)
    return replace(answer, fit=final), final, scale


def _refit_to_replays(fit: Fit, bank: FilterBank) -> Fit:
    """The values that replay best, without effects that these might as well lack."""
    again = fit_to_replays(fit, bank)
    while len(again.hypothesis.terms) > 1:
        doubtful = find_doubtful(again)
        if doubtful is None:
            break
        fewer = bank.linearise(again.hypothesis.without(doubtful))
        again = fit_to_replays(judge(fewer, bank, fit.noise), bank)
    return again


def polish_selection(
    selection: SearchResult, runs: Sequence[ObservedRun]
) -> tuple[Fit, FilterBank]:
    """Fitted once more to all runs under its own noise, with filters that suit it."""
    return polish(selection.best, runs, selection.reach)
