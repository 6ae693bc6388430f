"""Diagnosis: which physical effects a model lacks, how sure that is, and what is left unexplained.

filter bank     the base model runs along the train runs, corrected by a filter
camera          does the software of the motion capture smooth what it reports?
sensitivities   how each candidate would change what the filter could not foresee
search          add, refit, swap, prune; against what chance gives to the best of all candidates
held out        an addition must help on blocks it was not fitted to, and matter in 2 s windows;
                where a velocity is not measured, few blocks must not make it sure
validation      it must replay stretches well that took no part in choosing
structure       what is left, and no candidate explains; then those too that nobody would notice
masked laws     where nothing is: do names stand in for a law that they resemble?
joint fit       where there is some: all that could be wrong together, pruned; it competes
wandering       where what seems a current that wanders depends on the place: again, without one
replay fit      where there is some: values that replay best, rather than foresee the next reading
whole file      where there is none, and the vehicle file is off: all of it, fitted with the rest
common scale    does a factor of all forces stay open?
equation        where there is some: a law for it, if one holds; if not, the force in time
test runs       opened once, for the errors that are reported
"""

from dataclasses import replace
from typing import Callable, Iterator, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from rovsim.diagnosis.answer import (
    Answer,
    choose,
    finish,
    polish_selection,
    settle,
    settle_noticed,
)
from rovsim.diagnosis.checks.observability import list_not_observable
from rovsim.diagnosis.equations.disturbance import ForceInTime, trace_force
from rovsim.diagnosis.equations.masked import find_masked_laws
from rovsim.diagnosis.equations.proposal import Catalogued, ProposedLaw, propose_law
from rovsim.diagnosis.observer.camera import Smoothing, find_smoothing
from rovsim.diagnosis.observer.divergence import ModelLost, require_finite
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.noise import FIRST_NOISE
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.observer.usable_runs import UsableRuns, select_usable
from rovsim.diagnosis.selection.candidates import list_candidates
from rovsim.diagnosis.selection.filter_delay import (
    SearchStart,
    absorb_delay,
    search_consistent,
    seen_through,
)
from rovsim.diagnosis.selection.fit import Fit
from rovsim.diagnosis.selection.forward_selection import search
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation, keep_apart
from rovsim.diagnosis.selection.joint_fit import fit_jointly
from rovsim.diagnosis.selection.ranking import (
    Named,
    doubt_lead,
    doubt_names,
    doubt_small,
    find_stand_ins,
    name_drift,
    name_smoothing,
    name_terms,
    rank_alone,
    rank_selected,
)
from rovsim.diagnosis.selection.remaining_noise import fit_remaining_noise
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.sensitivities import linearise_candidates
from rovsim.diagnosis.selection.white_columns import WhiteColumns
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.diagnosis.train_diagnosis import TrainDiagnosis
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.uncertainty import correlate
from rovsim.results.fitted import Correlation

Stages = Callable[[str], None]


def diagnose_train_runs(
    base: Model,
    train: Sequence[ObservedRun],
    settings: SearchSettings,
    *,
    catalogue: Catalogue,
    seed: int = 0,
    stage: Stages = lambda name: None,
) -> TrainDiagnosis:
    """Find what a model lacks on the train runs of a campaign."""
    one_thread = threadpool_limits(1, "blas")  # matrices are too small for several to help
    # models that diverge on the way are refused by what is not finite
    with one_thread, np.errstate(over="ignore", invalid="ignore"):
        usable = select_usable(train)
        while usable.enough:
            try:
                return _diagnose(base, usable, settings, catalogue, seed, stage)
            except ModelLost as away:
                runs, lost = away.leave_out(usable.runs)
                usable = select_usable(runs, {**usable.lost, **lost})
        return TrainDiagnosis(base, usable)


def _diagnose(
    base: Model,
    usable: UsableRuns,
    settings: SearchSettings,
    catalogue: Catalogue,
    seed: int,
    stage: Stages,
    smooths: bool = True,
) -> TrainDiagnosis:
    """`smooths`: whether the cameras may smooth."""
    stage("observing")
    smoothing = find_smoothing(base, usable.runs) if smooths else None
    chosen, apart = keep_apart(usable.runs)
    starts = _begin(base, smoothing, chosen, settings, catalogue)

    def search_from(start: SearchStart) -> tuple[SearchResult, Smoothing | None]:
        stage("searching")
        selection = search(start.workspace, start.nothing, seed)
        return (
            absorb_delay(selection, base, start.smoothing) if start.smoothing else (selection, None)
        )

    (nothing, workspace, _), selection, smoothing = search_consistent(starts, search_from)
    drifts = selection.best.noise.drift is not None
    holdout = HoldoutValidation(apart, usable.runs, drifts)
    answer = _unmask(settle_noticed(selection, usable, holdout, seed))
    if smoothing and holdout.refuses(answer.fit.hypothesis.model, base):
        return _diagnose(base, usable, settings, catalogue, seed, stage, smooths=False)
    stage("checking")
    if answer.lasting:
        seen = seen_through(base, smoothing)
        joint = settle(fit_jointly(workspace, seen, usable.moved), usable, holdout)
        answer = choose(answer, _unmask(joint), holdout)
    noise, e = answer.fit.noise, answer.fit.seen.e
    if noise.drift and answer.bank.varies_with_place(e, noise):
        calm = usable.where_no_water_wanders()
        return _diagnose(base, calm, settings, catalogue, seed, stage, smooths)
    answer, wider, scale = finish(answer, usable.runs)
    camera = [name_smoothing(smoothing)] if smoothing else []
    law = _propose(answer, base, holdout, usable, camera) if answer.lasting else None
    rivals = answer.selection.named_rivals
    terms = name_terms(wider, rivals)
    named = [*camera, *(doubt_lead(terms) if camera else terms)]
    stand_ins = find_stand_ins(named, law.beside) if law else set()
    named = doubt_names(named, stand_ins)
    proposed = law if law and law.whole else None
    if answer.fit.noise.drift:
        drift = answer.bank.measure_drift(answer.fit.seen.e, answer.fit.noise)
        if drift.sure:
            named.append(name_drift(drift, answer.lasting))
    selected = rank_selected(base, named, usable.runs)
    if answer.structures and not proposed:
        selected = doubt_small(selected, answer.structures[0].share)
    return TrainDiagnosis(
        base,
        usable,
        answer.fit,
        _correlate(wider),
        selected,
        ranking=rank_alone(workspace, nothing, answer.fit),
        rivals=rivals,
        structures=answer.structures,
        refused=answer.refused or not answer.fit.is_finite,
        scale=scale,
        not_observable=list_not_observable(answer.selection, catalogue, base.vehicle),
        proposed=proposed,
        stand_ins=tuple(sorted(stand_ins)),
        disturbance=None if proposed else _trace(answer),
    )


def _unmask(answer: Answer) -> Answer:
    """An answer that seems to leave nothing, beside a law that its names may stand in for."""
    if answer.lasting or answer.whole is not None:
        return answer
    masked = find_masked_laws(answer.selection)
    return replace(answer, structures=(*masked, *answer.structures))


def _begin(
    base: Model,
    smoothing: Smoothing | None,
    runs: Sequence[ObservedRun],
    settings: SearchSettings,
    catalogue: Catalogue,
) -> Iterator[SearchStart]:
    """From where to search, the last one where none before ends where it began; made when asked.

    Behind a filter what the motion tells of its delay is used before that is taken for something
    else. But where it is far from what the noise tells, something else may pass for a delay: then
    what the noise tells comes first.
    """

    def look(smoothing: Smoothing | None) -> SearchStart:
        seen = seen_through(base, smoothing)
        workspace = _observe(seen, runs, settings, catalogue)
        return SearchStart(workspace.fit(Hypothesis(seen)), workspace, smoothing)

    told = look(smoothing)
    if smoothing is None:
        yield told
        return
    _, finer = absorb_delay(SearchResult(told.workspace, told.nothing, ()), base, smoothing)
    if finer is smoothing or not finer.is_near(smoothing):
        yield told
    if finer is not smoothing:
        yield look(finer)


def _correlate(fit: Fit) -> Correlation:
    """How values hang together; nothing is said where a fit does not know it."""
    if not np.isfinite(fit.covariance).all():
        return Correlation()
    return correlate(fit.covariance, fit.hypothesis.parameter_names)


def _observe(
    base: Model, runs: Sequence[ObservedRun], settings: SearchSettings, catalogue: Catalogue
) -> SearchWorkspace:
    """Columns of the candidates, and the noise that is left when all of them may act at once.

    The columns are made with filters that take all the base misses for noise: these hold it close
    to the measurement. The filters of the search then suit the noise that was found.
    """
    first = FilterBank.design(runs, base, FIRST_NOISE)
    noise, _ = first.fit_noise(first.innovations(base), FIRST_NOISE)
    close = first.redesign(base, noise)
    listed = list_candidates(runs, catalogue, base.vehicle)
    candidates = [one for one in listed if (base + one.start).possible]
    while True:
        sensitivities = linearise_candidates(close, Hypothesis(base), candidates)
        require_finite(sensitivities.base)
        noise = fit_remaining_noise(sensitivities, Hypothesis(base), noise)
        if not noise.drift or close.paths:
            break
        close = close.redesign(base, noise)  # forces differ where the water moves
    workspace = SearchWorkspace(WhiteColumns(close, sensitivities, noise), settings)
    return workspace.with_noise(Hypothesis(base), noise)


def _propose(
    answer: Answer,
    base: Model,
    holdout: HoldoutValidation,
    usable: UsableRuns,
    camera: Sequence[Named],
) -> ProposedLaw | None:
    """An equation for what is left, where one holds."""

    def polish(with_law: Fit) -> tuple[Fit, FilterBank]:
        return polish_selection(replace(answer.selection, best=with_law), usable.runs)

    whole = answer.fit.hypothesis.model
    best = Catalogued(whole, answer.replayed if holdout.runs else whole)
    return propose_law(answer.selection, best, base, holdout, usable.runs, polish, camera)


def _trace(answer: Answer) -> ForceInTime | None:
    """The force in time that is left; None where nothing is seen of it, or no filter holds."""
    if not answer.structures or not answer.fit.is_finite:
        return None
    return trace_force(answer.fit, answer.bank, answer.structures)
