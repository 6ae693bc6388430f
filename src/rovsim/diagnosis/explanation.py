"""What explains the train runs: searched, settled, and again where a premise proves wrong."""

from dataclasses import dataclass, replace
from typing import Callable, Iterator, Sequence

from rovsim.diagnosis.answer import SettledAnswer, choose, settle, settle_noticed
from rovsim.diagnosis.equations.masked import find_masked_laws
from rovsim.diagnosis.selection.filter_delay import (
    SearchStart,
    absorb_delay,
    search_consistent,
    seen_through,
)
from rovsim.diagnosis.selection.forward_selection import search
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation, keep_apart
from rovsim.diagnosis.selection.joint_fit import fit_jointly
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
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

Stages = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class DiagnosisProblem:
    """What is to be explained, and what is taken for given meanwhile.

    `smooths`: whether the cameras may smooth; `usable` says whether the water may wander.
    """

    base: Model
    usable: UsableRuns
    settings: SearchSettings
    catalogue: Catalogue
    seed: int
    smooths: bool = True


@dataclass(frozen=True, eq=False)
class Explanation:
    """An answer, where its search began, and what it was validated by.

    `problem`: as it was solved; `smoothing` of the cameras, None for none.
    """

    problem: DiagnosisProblem
    answer: SettledAnswer
    start: SearchStart
    smoothing: Smoothing | None
    holdout: HoldoutValidation


def explain(problem: DiagnosisProblem, stage: Stages) -> Explanation:
    """What explains the runs; asked anew without a premise that does not hold.

    Raises:
        ModelLost: no filter holds the model to some of the runs.
    """
    base, usable = problem.base, problem.usable
    stage("observing")
    smoothing = find_smoothing(base, usable.runs) if problem.smooths else None
    chosen, apart = keep_apart(usable.runs)

    def search_from(start: SearchStart) -> tuple[SearchResult, Smoothing | None]:
        stage("searching")
        selection = search(start.workspace, start.nothing, problem.seed)
        return (
            absorb_delay(selection, base, start.smoothing) if start.smoothing else (selection, None)
        )

    starts = _begin(problem, smoothing, chosen)
    start, selection, smoothing = search_consistent(starts, search_from)
    holdout = HoldoutValidation(apart, usable.runs, selection.best.noise.drift is not None)
    answer = _unmask(settle_noticed(selection, usable, holdout, problem.seed))
    if smoothing and holdout.refuses(answer.fit.hypothesis.model, base):
        return explain(replace(problem, smooths=False), stage)
    stage("checking")
    if answer.lasting:
        seen = seen_through(base, smoothing)
        joint = settle(fit_jointly(start.workspace, seen, usable.moved), usable, holdout)
        answer = choose(answer, _unmask(joint), holdout)
    noise = answer.fit.noise
    if noise.drift and answer.bank.varies_with_place(answer.fit.linearised.e, noise):
        return explain(replace(problem, usable=usable.where_no_water_wanders()), stage)
    return Explanation(problem, answer, start, smoothing, holdout)


def _unmask(answer: SettledAnswer) -> SettledAnswer:
    """An answer that seems to leave nothing, beside a law that its names may stand in for."""
    if answer.lasting or answer.whole is not None:
        return answer
    masked = find_masked_laws(answer.selection)
    return replace(answer, structures=(*masked, *answer.structures))


def _begin(
    problem: DiagnosisProblem, smoothing: Smoothing | None, runs: Sequence[ObservedRun]
) -> Iterator[SearchStart]:
    """From where to search, the last one where none before ends where it began; made when asked.

    Behind a filter what the motion tells of its delay is used before that is taken for something
    else. But where it is far from what the noise tells, something else may pass for a delay: then
    what the noise tells comes first.
    """

    def look(smoothing: Smoothing | None) -> SearchStart:
        seen = seen_through(problem.base, smoothing)
        workspace = _observe(seen, runs, problem)
        return SearchStart(workspace.fit(Hypothesis(seen)), workspace, smoothing)

    told = look(smoothing)
    if smoothing is None:
        yield told
        return
    nothing = SearchResult(told.workspace, told.nothing, ())
    _, finer = absorb_delay(nothing, problem.base, smoothing)
    if finer is smoothing or not finer.is_near(smoothing):
        yield told
    if finer is not smoothing:
        yield look(finer)


def _observe(
    base: Model, runs: Sequence[ObservedRun], problem: DiagnosisProblem
) -> SearchWorkspace:
    """Columns of the candidates, and the noise that is left when all of them may act at once.

    The columns are made with filters that take all the base misses for noise: these hold it close
    to the measurement. The filters of the search then suit the noise that was found.
    """
    first = FilterBank.design(runs, base, FIRST_NOISE)
    noise, _ = first.fit_noise(first.innovations(base), FIRST_NOISE)
    close = first.redesign(base, noise)
    listed = list_candidates(runs, problem.catalogue, base.vehicle)
    candidates = [one for one in listed if (base + one.start).possible]
    while True:
        sensitivities = linearise_candidates(close, Hypothesis(base), candidates)
        require_finite(sensitivities.base)
        noise = fit_remaining_noise(sensitivities, Hypothesis(base), noise)
        if not noise.drift or close.paths:
            break
        close = close.redesign(base, noise)  # forces differ where the water moves
    workspace = SearchWorkspace(WhiteColumns(close, sensitivities, noise), problem.settings)
    return workspace.with_noise(Hypothesis(base), noise)
