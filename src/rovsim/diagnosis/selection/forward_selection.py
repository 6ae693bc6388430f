"""Which effects are missing: add the likeliest, refit all, try swaps, remove what is not needed."""

from dataclasses import replace
from functools import partial

from rovsim.core.threads import map_on_cores
from rovsim.diagnosis.selection.curvature import list_curved
from rovsim.diagnosis.selection.imitation import drop_imitations
from rovsim.diagnosis.selection.promising import (
    NEARLY_BEST_SHARE,
    Swap,
    explains_enough,
    keep_close,
    list_promising,
    list_swaps,
)
from rovsim.diagnosis.selection.proposals import Proposal
from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.search_result import Rival, SearchResult, keep_likeliest
from rovsim.diagnosis.selection.steady_current import challenge_steady, prefer_steady
from rovsim.diagnosis.selection.thresholds import add_term, place_thresholds
from rovsim.diagnosis.selection.vehicle_file.loose_file import Contender, LooseFile
from rovsim.diagnosis.selection.vehicle_file.special_effects import judge_beside_file
from rovsim.diagnosis.selection.vehicle_file.steps import (
    add_file_effects,
    fix_gain,
    prefer_file,
    suspect_loose_file,
)
from rovsim.diagnosis.selection.wide_effects import spread_wide
from rovsim.diagnosis.selection.workspace import HOPELESS_LR, SearchWorkspace
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis

TRIAL_ROUNDS = 3  # of trials, where none of the first additions is accepted
SWAPS_AT_ONCE = 4  # refitted side by side, on however many cores; few are accepted
MIN_LR_OF_SWAP = 1.0  # of the deviance: less is not worth another name
# Of what the last addition explained: while more is sought, less is not worth a swap.
MIN_SWAP_SHARE = 0.01
MAX_SHAPE_STD = 0.5  # scales: the standard deviation of a shape, by which two scales are told apart


def add_best(workspace: SearchWorkspace, current: Fit, threshold: float) -> Fit | None:
    """Add the effect that explains most, refit and prune; None where no effect is accepted.

    An effect is accepted if it explains more than chance would and replays without it are
    noticeably worse. Where the vehicle file is loose, a special effect is not accepted if all of
    the file together explains the same; if nothing else is left, several numbers of the file may be
    accepted that only matter together.

    Args:
        workspace: of the search.
        current: the fit so far.
        threshold: least gain of the score, see `SearchWorkspace.chance_limit`.
    """
    for proposals in (list_promising, list_curved):
        if fit := _add_likeliest(workspace, current, threshold, proposals(workspace, current)):
            return fit
    loose = has_loose_file(current.hypothesis)
    with_file = add_file_effects(workspace, current) if loose else current
    if not _beats_chance(workspace, with_file, current, threshold):
        return None
    relevant = workspace.find_relevant(with_file, [current.hypothesis.model])[0]
    return prune(workspace, with_file) if relevant else None


def _add_likeliest(
    workspace: SearchWorkspace, current: Fit, threshold: float, proposals: list[Proposal]
) -> Fit | None:
    """Fit the best proposals, a few at a time, until one is accepted; None where none is."""
    file, loose = LooseFile(workspace), has_loose_file(current.hypothesis)
    for _ in range(TRIAL_ROUNDS):
        level = sum(
            p.net_decrease > NEARLY_BEST_SHARE * proposals[0].net_decrease for p in proposals
        )
        batch = keep_close(proposals, max(workspace.settings.trials, level))
        proposals = [p for p in proposals if p not in batch]

        def refit(p: Proposal) -> Fit:
            return workspace.fit(add_term(workspace, current.hypothesis, p.term))

        fits = zip(map_on_cores(refit, batch), (p.term.id for p in batch), strict=True)
        for trial, name in sorted(fits, key=lambda pair: workspace.score(pair[0]), reverse=True):
            if not _beats_chance(workspace, trial, current, threshold):
                break
            if loose and file.explains(trial, name, current):
                continue
            if workspace.find_relevant(trial, [current.hypothesis.model])[0]:
                return prune(workspace, trial)
    return None


def _beats_chance(workspace: SearchWorkspace, more: Fit, less: Fit, threshold: float) -> bool:
    return more is not less and workspace.score(more) - workspace.score(less) >= threshold


def swap_terms(workspace: SearchWorkspace, current: Fit, min_gain: float = MIN_LR_OF_SWAP) -> Fit:
    """Replace any one term by the likeliest other effect, as long as that is likelier.

    Args:
        workspace: of the search.
        current: the fit so far.
        min_gain: by how much the score has to be larger after a swap.
    """
    return _try_swaps(workspace, current, 1, min_gain, -min_gain)[0]


def swap_and_list_rivals(workspace: SearchWorkspace, current: Fit) -> tuple[Fit, list[Rival]]:
    """Replace any one term by another effect, as long as that is likelier, and list the others.

    Returns:
        The likeliest fit, and the effects that could stand in the place of each of its terms.
    """
    trials = workspace.settings.trials
    return _try_swaps(workspace, current, trials, MIN_LR_OF_SWAP, HOPELESS_LR)


def _try_swaps(
    workspace: SearchWorkspace, current: Fit, trials: int, min_gain: float, tracked_deficit: float
) -> tuple[Fit, list[Rival]]:
    """Try other effects in the place of each term, the likeliest first, anew after each swap.

    An effect that to first order explains less than half of what the term does is not refitted,
    unless its smaller penalty makes up for that.

    Args:
        workspace: of the search.
        current: the fit so far.
        trials: how many effects are refitted in the place of each term, at least.
        min_gain: by how much the score has to be larger after a swap.
        tracked_deficit: by how much the score of a rival may be smaller for that to be found out; a
            fit that will surely be worse is given up.
    """
    rivals, file, loose = [], LooseFile(workspace), has_loose_file(current.hypothesis)
    swaps = list_swaps(workspace, current, trials)
    least = workspace.score(current) - tracked_deficit
    refit = partial(_refit_if_promising, workspace, current, least)
    for some in (swaps[k : k + SWAPS_AT_ONCE] for k in range(0, len(swaps), SWAPS_AT_ONCE)):
        refits = map_on_cores(refit, some)
        for swap, (trial, deficit) in zip(some, refits, strict=True):
            term, other = swap.term, swap.proposal.term
            if trial is not None:
                if deficit < -min_gain and not (loose and file.explains(trial, other.id)):
                    swapped = prune(workspace, trial)
                    return _try_swaps(workspace, swapped, trials, min_gain, tracked_deficit)
                weight = file.weigh(Contender(current, term), Contender(trial, other), deficit)
                deficit = max(0.0, weight)  # likelier, but not beside a loose file: undecided
            rivals.append(Rival(other.id, term.id, deficit, trial))
    return current, rivals


def _refit_if_promising(
    workspace: SearchWorkspace, current: Fit, least: float, swap: Swap
) -> tuple[Fit | None, float]:
    """Refit with another effect in the place of a term, where it explains enough to first order.

    Returns:
        The fit, and by how much its score is smaller than that of `current`. None where it was not
        made, or given up since its score will surely not reach `least`.
    """
    deficit = swap.predict_deficit(workspace)
    if deficit >= 0.0 and not explains_enough(workspace, swap.rest, swap.proposal):
        return None, deficit
    trial = workspace.fit_unless_below(swap.begin(workspace), current, least)
    deficit = HOPELESS_LR if trial is None else workspace.score(current) - workspace.score(trial)
    return trial, deficit


def change_mode(workspace: SearchWorkspace, current: Fit) -> Fit:
    """Try the other modes of each effect that has modes; keep one that is likelier.

    Swaps alone do not get there. A slow loop on board that holds an angle, together with too much
    drag, moves the vehicle like a loop that holds a rate, and neither of the two can be removed or
    swapped by itself. The same holds for a slow loop of the same mode together with drag, so the
    effect's own mode is tried from its start again, too.
    """
    h = current.hypothesis
    for i, term in enumerate(h.terms):
        for start in workspace.list_modes(term):
            if trial := _fit_if_likelier(workspace, h.replaced(i, start), current):
                return trial
    return current


def _fit_if_likelier(workspace: SearchWorkspace, start: Hypothesis, current: Fit) -> Fit | None:
    """Fit and prune a start; None where that is not likelier than the current fit."""
    trial = prune(workspace, workspace.fit(start))
    likelier = workspace.score(trial) > workspace.score(current) + MIN_LR_OF_SWAP
    return trial if likelier else None


def move_thresholds(workspace: SearchWorkspace, current: Fit) -> Fit:
    """Place each threshold anew beside the effects accepted since, where that is likelier."""
    for term in current.hypothesis.terms:
        h = place_thresholds(workspace, current.hypothesis, term)
        if h is not current.hypothesis:
            current = _fit_if_likelier(workspace, h, current) or current
    return current


def free_shape(workspace: SearchWorkspace, current: Fit) -> Fit:
    """Free the shape of an effect where the runs determine it, such as how far a wall reaches.

    A shape at its usual value would make other effects compensate for it, and the effect's gain
    would seem surer than it is.
    """
    h = current.hypothesis
    for i, term in enumerate(h.terms):
        shape = tuple(p.name for p in term.effect.parameters if p.shape and p.name not in term.free)
        if shape:
            trial = workspace.fit(h.replaced(i, replace(term, free=(*term.free, *shape))))
            columns = trial.hypothesis.columns[i][-len(shape) :]
            determined = trial.is_finite and (trial.std[columns] < MAX_SHAPE_STD).all()
            if determined and workspace.score(trial) > workspace.score(current) - MIN_LR_OF_SWAP:
                return free_shape(workspace, prune(workspace, trial))
    return current


def begin_search(workspace: SearchWorkspace, base: Fit, seed: int) -> SearchResult:
    """Add effects to a fit of the base, and swap, until no addition beats chance.

    The noise and the filters of the workspace follow what is accepted on the way.

    Args:
        workspace: the candidates, and the runs they are judged on.
        base: a fit to begin with, usually of the base without any effect.
        seed: of the draws that tell what chance explains.
    """
    workspace, current = _add_and_swap(*prefer_steady(workspace, base), seed)
    loose = suspect_loose_file(workspace, current)
    if loose is not current:
        workspace, current = _add_and_swap(workspace, loose, seed)
    full = not _may_add(workspace, current)
    stopped = full and _add_next(workspace, current, seed) is not None
    return SearchResult(workspace, current, (), stopped=stopped)


def finish_search(begun: SearchResult, seed: int) -> SearchResult:
    """Change what a search accepted until nothing can be swapped or removed, and list rivals."""
    workspace = begun.workspace.relinearise_if_changed(begun.best)
    current = swap_terms(workspace, begun.best)
    current = spread_wide(workspace, current, partial(_add_and_swap, seed=seed), MIN_LR_OF_SWAP)
    current = drop_imitations(workspace, change_mode(workspace, current))
    verdict = judge_beside_file(workspace, prefer_file(workspace, current))
    current = free_shape(workspace, fix_gain(workspace, verdict.fit))
    workspace, current, wandering = challenge_steady(workspace, current)
    current, rivals = swap_and_list_rivals(workspace, current)
    every = [*rivals, *verdict.rivals, *wandering]
    return SearchResult(workspace, current, keep_likeliest(every), stopped=begun.stopped)


def _add_and_swap(
    workspace: SearchWorkspace, current: Fit, seed: int
) -> tuple[SearchWorkspace, Fit]:
    """Add effects, and swap after each addition, until no addition beats chance."""
    while _may_add(workspace, current):
        extended = _add_next(workspace, current, seed)
        if extended is None:
            break
        gain = workspace.score(extended) - workspace.score(current)
        workspace, polished = prefer_steady(*workspace.refit_updated(extended))
        polished = free_shape(workspace, move_thresholds(workspace, polished))
        current = swap_terms(workspace, polished, max(MIN_LR_OF_SWAP, MIN_SWAP_SHARE * gain))
    return workspace, current


def _add_next(workspace: SearchWorkspace, current: Fit, seed: int) -> Fit | None:
    return add_best(workspace, current, workspace.chance_limit(current, seed))


def _may_add(workspace: SearchWorkspace, current: Fit) -> bool:
    return len(current.hypothesis.terms) < workspace.settings.most_effects


def search_unnoticed(selection: SearchResult, seed: int) -> SearchResult:
    """Continue a search with effects that hardly change the error in 2 s windows."""
    workspace = selection.workspace
    settings = workspace.settings.model_copy(update={"relevant": 0.0})
    begun = begin_search(replace(workspace, settings=settings), selection.best, seed)
    return finish_search(begun, seed)
