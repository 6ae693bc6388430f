"""Which effects are missing: add the most likely one, refit all, try to swap, drop what is idle."""

from dataclasses import replace

from rovsim.diagnosis.selection.promising import (
    NEARLY_BEST_SHARE,
    PROMISING_SHARE,
    find_swaps,
    keep_close,
    list_promising,
    measure_explained,
)
from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.search_result import Rival, SearchResult, keep_likeliest
from rovsim.diagnosis.selection.steady_current import prefer_steady
from rovsim.diagnosis.selection.thresholds import place_thresholds
from rovsim.diagnosis.selection.vehicle_file.loose_file import Contender, LooseFile
from rovsim.diagnosis.selection.vehicle_file.special_effects import judge_beside_file
from rovsim.diagnosis.selection.vehicle_file.steps import (
    add_file_effects,
    fix_gain,
    prefer_file,
    suspect_loose_file,
)
from rovsim.diagnosis.selection.workspace import HOPELESS_LR, SearchWorkspace
from rovsim.estimation.file_effects import has_loose_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis

ROUNDS = 3  # of trials, when none of the first matters
MIN_LR_OF_SWAP = 1.0  # of the deviance: less is not worth another name
# Of what the last addition explained: while more is sought, less is not worth a swap.
MIN_SWAP_SHARE = 0.01
DETERMINED = 0.5  # scales: the standard deviation of a shape, by which two scales are told apart


def add_best(workspace: SearchWorkspace, current: Fit, threshold: float) -> Fit | None:
    """The best single addition, refitted and pruned; None when none beats chance and matters.

    Where the vehicle file is loose, it is no special effect that the file explains; if nothing else
    is left, several numbers of the file that only matter together.
    """
    left, file = list_promising(workspace, current), LooseFile(workspace)
    loose = has_loose_file(current.hypothesis)
    for _ in range(ROUNDS):
        level = sum(p.net_decrease > NEARLY_BEST_SHARE * left[0].net_decrease for p in left)
        trying = keep_close(left, max(workspace.settings.trials, level))
        left = [p for p in left if p not in trying]
        starts = (
            place_thresholds(workspace, current.hypothesis.with_term(p.term), p.term)
            for p in trying
        )
        tried = [(workspace.fit(start), p.term.id) for start, p in zip(starts, trying, strict=True)]
        for best, name in sorted(tried, key=lambda one: workspace.score(one[0]), reverse=True):
            if not _beats_chance(workspace, best, current, threshold):
                break
            if loose and file.explains(best, name):
                continue
            if workspace.find_relevant(best, [current.hypothesis.model])[0]:
                return prune(workspace, best)
    more = add_file_effects(workspace, current) if loose else current
    if not _beats_chance(workspace, more, current, threshold):
        return None
    noticed = workspace.find_relevant(more, [current.hypothesis.model])[0]
    return prune(workspace, more) if noticed else None


def _beats_chance(workspace: SearchWorkspace, more: Fit, less: Fit, threshold: float) -> bool:
    return more is not less and workspace.score(more) - workspace.score(less) >= threshold


def try_swaps(
    workspace: SearchWorkspace, current: Fit, trials: int, swap: float = MIN_LR_OF_SWAP
) -> tuple[Fit, list[Rival]]:
    """Replace any one term by another effect while that is more likely; then what comes close.

    Names that should explain less than half of what the term does are not refitted, unless for that
    they ask so much less that they seem likelier.

    `swap`: the least difference of the scores.
    """
    rivals, file, loose = [], LooseFile(workspace), has_loose_file(current.hypothesis)
    rests = workspace.remove_each(current)
    for term, rest in zip(current.hypothesis.terms, rests, strict=True):
        for p in find_swaps(workspace, term, rest, trials):
            trial = None
            worse = rest.ss_increase - workspace.penalty * term.choices - p.net_decrease
            if worse < 0.0 or measure_explained(workspace, p) > PROMISING_SHARE * rest.ss_increase:
                start, worse = rest.hypothesis.with_term(p.term), HOPELESS_LR
                start = place_thresholds(workspace, start, p.term)
                trial = workspace.fit_unless_worse(start, current, workspace.score(current))
            if trial is not None:
                worse = workspace.score(current) - workspace.score(trial)
                if worse < -swap and not (loose and file.explains(trial, p.term.id)):
                    return try_swaps(workspace, prune(workspace, trial), trials, swap)
                weight = file.weigh(Contender(current, term), Contender(trial, p.term), worse)
                worse = max(0.0, weight)  # likelier only beside a loose file: not told apart
            rivals.append(Rival(p.term.id, term.id, worse, trial))
    return current, rivals


def change_mode(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With effects that have modes in another one, where that is more likely.

    A loop that holds an angle, but slowly, and more drag than there is do what a loop that holds a
    rate does alone: neither of the two can be taken away or swapped by itself. So do a slow loop of
    the same mode, and drag, so that its own start is tried again as well.
    """
    h = current.hypothesis
    for i, term in enumerate(h.terms):
        for start in workspace.list_modes(term):
            if trial := _fit_if_likelier(workspace, h.replaced(i, start), current):
                return trial
    return current


def _fit_if_likelier(workspace: SearchWorkspace, start: Hypothesis, current: Fit) -> Fit | None:
    """A start, fitted and pruned; None where it is not likelier than the current fit."""
    trial = prune(workspace, workspace.fit(start))
    likelier = workspace.score(trial) > workspace.score(current) + MIN_LR_OF_SWAP
    return trial if likelier else None


def move_thresholds(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With each threshold elsewhere, where that is likelier beside what was found since."""
    for term in current.hypothesis.terms:
        moved = place_thresholds(workspace, current.hypothesis, term)
        if moved is not current.hypothesis:
            current = _fit_if_likelier(workspace, moved, current) or current
    return current


def free_shape(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With the shape of an effect free where the data determine it: how far from a wall it reaches.

    Left as it usually is, it would have other effects make up for it, and its gain would seem surer
    than it is.
    """
    h = current.hypothesis
    for i, term in enumerate(h.terms):
        shape = tuple(p.name for p in term.effect.parameters if p.shape and p.name not in term.free)
        if shape:
            trial = workspace.fit(h.replaced(i, replace(term, free=(*term.free, *shape))))
            own = trial.hypothesis.columns[i][-len(shape) :]
            determined = trial.is_finite and (trial.std[own] < DETERMINED).all()
            if determined and workspace.score(trial) > workspace.score(current) - MIN_LR_OF_SWAP:
                return free_shape(workspace, prune(workspace, trial))
    return current


def search(workspace: SearchWorkspace, base: Fit, seed: int) -> SearchResult:
    """From the base to the model to which nothing can be added, swapped or taken away.

    The workspace's noise and filters follow what is found.
    """
    workspace, current = _add_and_swap(*prefer_steady(workspace, base), seed)
    loose = suspect_loose_file(workspace, current)
    if loose is not current:
        workspace, current = _add_and_swap(workspace, loose, seed)
    workspace = workspace.relinearise_if_changed(current)
    current, _ = try_swaps(workspace, current, 1)
    current = change_mode(workspace, current)
    judged = judge_beside_file(workspace, prefer_file(workspace, current))
    current = free_shape(workspace, fix_gain(workspace, judged.fit))
    current, rivals = try_swaps(workspace, current, workspace.settings.trials)
    return SearchResult(workspace, current, keep_likeliest([*rivals, *judged.rivals]))


def _add_and_swap(
    workspace: SearchWorkspace, current: Fit, seed: int
) -> tuple[SearchWorkspace, Fit]:
    """Add and swap until nothing more beats chance."""
    while len(current.hypothesis.terms) < workspace.settings.most_effects:
        more = add_best(workspace, current, workspace.chance_limit(current, seed))
        if more is None:
            break
        gained = workspace.score(more) - workspace.score(current)
        workspace = workspace.update_after(more)
        workspace, again = prefer_steady(workspace, workspace.fit(more.hypothesis))
        again = free_shape(workspace, move_thresholds(workspace, again))
        swap = max(MIN_LR_OF_SWAP, MIN_SWAP_SHARE * gained)
        current, _ = try_swaps(workspace, again, 1, swap)  # the likeliest other name
    return workspace, current


def search_unnoticed(selection: SearchResult, seed: int) -> SearchResult:
    """From where a search ended on, by effects too that hardly change the error in 2 s windows."""
    workspace = selection.workspace
    settings = workspace.settings.model_copy(update={"relevant": 0.0})
    return search(replace(workspace, settings=settings), selection.best, seed)
