"""Search the train runs for missing effects and validate them, again where an assumption fails.

Two things are assumed at first: that the cameras smooth the poses if their noise looks as if they
did, and that the current may wander. Where an answer contradicts one of them, all is done anew
without it.
"""

from dataclasses import dataclass, replace
from typing import Collection, Iterator, Sequence

from rovsim.core.progress import begin_stage
from rovsim.diagnosis.answer import (
    SettledAnswer,
    choose_answer,
    settle,
    settle_noticed,
    settle_without,
)
from rovsim.diagnosis.checks.clocks import find_clock_difference
from rovsim.diagnosis.checks.feedback_axes import find_feedback_axes, find_feedback_only
from rovsim.diagnosis.checks.needless_effects import find_needless
from rovsim.diagnosis.checks.run_differences import (
    RunDifference,
    find_harmful,
    find_run_difference,
)
from rovsim.diagnosis.checks.varying_effects import find_varying
from rovsim.diagnosis.equations.masked import find_masked_laws
from rovsim.diagnosis.selection.filter_delay import (
    SearchStart,
    absorb_delay,
    search_with_consistent_filter,
    with_camera_filter,
)
from rovsim.diagnosis.selection.forward_selection import begin_search, finish_search
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation, keep_apart
from rovsim.diagnosis.selection.joint_fit import fit_jointly
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import DiagnosisSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.estimation.candidates import list_candidates
from rovsim.estimation.observer.camera import Smoothing, find_smoothing
from rovsim.estimation.observer.divergence import require_finite
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.observer.usable_runs import UsableRuns
from rovsim.estimation.remaining_noise import fit_remaining_noise
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns


@dataclass(frozen=True, eq=False)
class DiagnosisProblem:
    """What is to be explained, and under which assumptions.

    Attributes:
        base: the model that is diagnosed.
        usable: the train runs; each says whether the current may wander in it.
        settings: how the search decides, and how runs are filtered and replayed.
        catalogue: the effects that may be missing.
        cameras_may_smooth: whether a filter of the cameras is looked for.
    """

    base: Model
    usable: UsableRuns
    settings: DiagnosisSettings
    catalogue: Catalogue
    cameras_may_smooth: bool = True


@dataclass(frozen=True, eq=False)
class ValidatedSearch:
    """A validated answer, and how it was found.

    Attributes:
        problem: the problem with the assumptions that held in the end.
        answer: the accepted effects, and what they leave.
        start: where the search began.
        smoothing: the filter of the cameras; None where they do not smooth.
        holdout: the stretches that the answer was validated on.
        varying: ids of accepted effects whose values vary from run to run, where nothing is left.
        feedback_only: ids of accepted effects that only show where an autopilot knows more.
        difference: an effect that has another value in each run; None where there is none.
    """

    problem: DiagnosisProblem
    answer: SettledAnswer
    start: SearchStart
    smoothing: Smoothing | None
    holdout: HoldoutValidation
    varying: Collection[str]
    feedback_only: Collection[str]
    difference: RunDifference | None


def search_and_validate(problem: DiagnosisProblem) -> ValidatedSearch:
    """Search for the missing effects and validate them, until the assumptions hold.

    Each stage is reported as it begins.

    Args:
        problem: what is to be explained.

    Raises:
        ModelDiverged: in some run the model diverges, whatever the filter's corrections.
    """
    base, usable, seed = problem.base, problem.usable, problem.settings.seed
    begin_stage("observing")
    smoothing = find_smoothing(base, usable.runs) if problem.cameras_may_smooth else None
    training, reserved = keep_apart(usable.runs)

    def search_from(start: SearchStart) -> tuple[SearchResult, Smoothing | None]:
        begin_stage("searching")
        begun = begin_search(start.workspace, start.base_fit, seed)
        if start.smoothing:
            return absorb_delay(finish_search(begun, seed), base, start.smoothing)
        # one that was stopped leaves much: it is finished where no joint fit is better
        return (begun if begun.stopped else finish_search(begun, seed)), None

    starts = _make_starts(problem, smoothing, training)
    start, selection, smoothing = search_with_consistent_filter(starts, search_from)
    drifts = selection.best.noise.drift is not None
    holdout = HoldoutValidation(reserved, usable.runs, drifts, problem.settings)
    answer = _unmask(settle_noticed(selection, usable, holdout, seed))
    if smoothing and holdout.refuses(answer.fit.hypothesis.model, base):
        return search_and_validate(replace(problem, cameras_may_smooth=False))
    begin_stage("checking")
    if answer.leaves_physics:
        answer = _challenge_jointly(answer, problem, start, smoothing, holdout)
    if selection.stopped and answer.selection.stopped and not smoothing:
        finished = settle_noticed(finish_search(selection, seed), usable, holdout, seed)
        answer = choose_answer(answer, _unmask(finished), holdout)
    noise = answer.fit.noise
    if noise.drift and answer.bank.varies_with_place(answer.fit.linearised.e, noise):
        return search_and_validate(replace(problem, usable=usable.where_no_water_wanders()))
    answer, feedback_only = _judge_feedback(answer, usable)
    varying = find_varying(answer.fit, answer.bank) if answer.complete else set()
    difference = None
    if varying or not answer.complete:
        answer, difference = _judge_difference(answer, problem, holdout)
    return ValidatedSearch(
        problem, answer, start, smoothing, holdout, varying, feedback_only, difference
    )


def _judge_difference(
    answer: SettledAnswer, problem: DiagnosisProblem, holdout: HoldoutValidation
) -> tuple[SettledAnswer, RunDifference | None]:
    """What runs differ in, and the answer without what makes up for that or does harm by it."""
    difference, usable = _find_difference(answer, problem), problem.usable
    if difference is None or not answer.fit.is_finite:
        return answer, difference
    answer, difference = _drop_needless(answer, difference, usable, holdout)
    reduced = _drop_harmful(answer, usable, holdout)
    if reduced is answer:
        return answer, difference
    return reduced, find_run_difference(reduced.selection) or difference


def _find_difference(answer: SettledAnswer, problem: DiagnosisProblem) -> RunDifference | None:
    """An effect that has another value in each run: one that explains what is left, or a clock."""
    return find_run_difference(answer.selection) or find_clock_difference(
        problem.base, problem.usable.runs, problem.settings
    )


def _challenge_jointly(
    answer: SettledAnswer,
    problem: DiagnosisProblem,
    start: SearchStart,
    smoothing: Smoothing | None,
    holdout: HoldoutValidation,
) -> SettledAnswer:
    """The better of an answer that leaves physics and of a joint fit of all that may be wrong."""
    found, usable = answer.fit.hypothesis, problem.usable
    filtered = with_camera_filter(problem.base, smoothing)
    joint = fit_jointly(start.workspace, filtered, usable.moved, found.terms)
    # the same effects again would only be held by the prior of a joint fit as well
    if joint.best.hypothesis.free_parameters == found.free_parameters:
        return answer
    return choose_answer(answer, _unmask(settle(joint, usable, holdout)), holdout)


def _judge_feedback(
    answer: SettledAnswer, usable: UsableRuns
) -> tuple[SettledAnswer, Collection[str]]:
    """Remove effects that only show where an autopilot knows more, and would show elsewhere.

    Of a joint fit no effect is sure by itself, so that none is judged.

    Returns:
        The answer without them, and the ids of those that would show nowhere else.
    """
    if not answer.complete or answer.selection.is_joint:
        return answer, frozenset()
    axes = find_feedback_axes(answer.whole_file_fit or answer.fit, answer.bank)
    weigh = answer.selection.workspace.weigh_term
    found = find_feedback_only(answer.fit, answer.bank, axes, weigh)
    if not found.refuted:
        return answer, found.unseen
    reduced = settle_without(answer, found.refuted[0], usable)
    if reduced is None:
        return answer, found.unseen | set(found.refuted)
    return _judge_feedback(reduced, usable)


def _unmask(answer: SettledAnswer) -> SettledAnswer:
    """Add to what an answer leaves any law that its accepted effects may only stand in for."""
    if answer.leaves_physics:
        return answer
    whole = answer.whole_file_fit
    gain = whole.two_log_likelihood - answer.fit.two_log_likelihood if whole else 0.0
    structures = find_masked_laws(answer.selection, gain)
    return replace(answer, structures=(*structures, *answer.structures))


def _drop_needless(
    answer: SettledAnswer,
    difference: RunDifference,
    usable: UsableRuns,
    holdout: HoldoutValidation,
) -> tuple[SettledAnswer, RunDifference]:
    """The answer without effects that only make up for what differs, and what then differs."""
    if not difference.explains:
        return answer, difference
    penalty = answer.selection.workspace.penalty
    needless = find_needless(answer.fit, answer.bank, difference, penalty)
    selection = answer.selection.without_effect(needless) if needless else None
    if selection is None:
        return answer, difference
    reduced = settle(selection, usable, holdout)
    remaining = find_run_difference(reduced.selection)
    if remaining is None or remaining.effect_id != difference.effect_id:
        return answer, difference
    return _drop_needless(reduced, remaining, usable, holdout)


def _drop_harmful(
    answer: SettledAnswer, usable: UsableRuns, holdout: HoldoutValidation
) -> SettledAnswer:
    """The answer without effects that do harm in some run, where runs differ.

    What is a mean of several values may do harm in a test run, too.
    """
    harmful = find_harmful(answer.fit.hypothesis, holdout)
    if harmful is None:
        return answer
    selection = answer.selection.without_effect(answer.fit.hypothesis.terms[harmful].id)
    if selection is None:
        return answer
    return _drop_harmful(settle(selection, usable, holdout), usable, holdout)


def _make_starts(
    problem: DiagnosisProblem, smoothing: Smoothing | None, runs: Sequence[ObservedRun]
) -> Iterator[SearchStart]:
    """Where to search from, each start made only when it is asked for.

    Where the cameras smooth, the delay of the motion gives the filter's cutoff more precisely than
    the noise does. So the search starts from that cutoff, before an effect can take up the delay.
    But another missing effect may look like a delay. If that search fails, one starts from the
    cutoff that the noise gives; where the two cutoffs are far apart, that one comes first.
    """

    def start_with(smoothing: Smoothing | None) -> SearchStart:
        filtered = with_camera_filter(problem.base, smoothing)
        workspace = _observe(filtered, runs, problem)
        return SearchStart(workspace.fit(Hypothesis(filtered)), workspace, smoothing)

    by_noise = start_with(smoothing)
    if smoothing is None:
        yield by_noise
        return
    no_effects = SearchResult(by_noise.workspace, by_noise.base_fit, ())
    _, by_delay = absorb_delay(no_effects, problem.base, smoothing)
    if by_delay is smoothing:
        yield by_noise
    elif by_delay.is_near(smoothing):
        yield start_with(by_delay)
        yield by_noise
    else:
        yield by_noise
        yield start_with(by_delay)


def _observe(
    base: Model, runs: Sequence[ObservedRun], problem: DiagnosisProblem
) -> SearchWorkspace:
    """Observe the runs, linearise all candidates, and fit the noise that is left beside them all.

    The candidates are linearised with filters that take everything the base lacks for noise, since
    these filters keep the base close to the measurement. The search then uses filters that suit the
    noise that is left when all candidates may act at once.
    """
    rough_bank = FilterBank.design(runs, base, FIRST_NOISE)
    noise, _ = rough_bank.fit_noise(rough_bank.innovations(base), FIRST_NOISE)
    bank = rough_bank.redesign(base, noise)
    listed = list_candidates(runs, problem.catalogue, base.vehicle)
    candidates = [c for c in listed if (base + c.start).possible]
    while True:
        sensitivities = linearise_candidates(bank, Hypothesis(base), candidates)
        require_finite(sensitivities.base)
        noise = fit_remaining_noise(sensitivities, Hypothesis(base), noise)
        if not noise.drift or bank.paths:
            break
        bank = bank.redesign(base, noise)  # forces differ where the water moves
    workspace = SearchWorkspace.begin(
        WhiteColumns(bank, sensitivities, noise), problem.settings.search
    )
    return workspace.with_noise(Hypothesis(base), noise)
