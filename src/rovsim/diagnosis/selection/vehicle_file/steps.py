"""What the vehicle file, where it is off anyway, explains as well as something that is rarer."""

from rovsim.diagnosis.selection.pruning import drop_parameters, prune
from rovsim.diagnosis.selection.search_result import MIN_LR_APART
from rovsim.diagnosis.selection.vehicle_file.loose_file import PRIOR_ODDS_LR, LooseFile
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.estimation.file_effects import (
    FILE_EFFECT_IDS,
    has_loose_file,
    mark_gain,
)
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Term


def prefer_file(workspace: SearchWorkspace, current: Fit) -> Fit:
    """Without effects that the vehicle file, where it is off anyway, explains about as well."""
    file, terms = LooseFile(workspace), current.hypothesis.terms
    if not any(term.id in FILE_EFFECT_IDS for term in terms):
        return current
    for term in terms:
        if file.explains(current, term.id):
            without_term = workspace.fit(workspace.first_order.drop(current, [(term,)])[0])
            trial = prune(workspace, add_file_effects(workspace, without_term))
            if _is_as_good(file, trial, current, term):
                return prefer_file(workspace, trial)
    return current


def _is_as_good(file: LooseFile, fewer: Fit, current: Fit, term: Term) -> bool:
    """Whether more of the file makes up for a special term, as far as such a term is rare."""
    if not has_loose_file(current.hypothesis):
        return file.workspace.score(fewer) > file.workspace.score(current) - PRIOR_ODDS_LR
    return file.measure_cost(fewer) - file.measure_cost(current) <= file.find_limit(term)


def suspect_loose_file(workspace: SearchWorkspace, current: Fit) -> Fit:
    """From where to search on, if the file is likelier to be off everywhere than right.

    Where each number of a file is a little off, none may be worth its penalty beside a special
    effect that takes what several of them would explain together. So the file as a whole competes
    with all special effects that it explains. It must be noticed, too: fins a tenth weaker, which
    nobody would notice, were three effects of the file at a probability of 0.997.
    """
    if has_loose_file(current.hypothesis):
        return current
    file, reduced = LooseFile(workspace), current
    while explained := _find_explained(file, reduced):
        reduced = workspace.fit(workspace.first_order.drop(reduced, [(explained,)])[0])
    if (
        workspace.score(reduced) + file.measure_doubt(reduced)
        < workspace.score(current) + MIN_LR_APART
    ):
        return current
    loose = add_file_effects(workspace, reduced)
    # first-order predictions of many numbers together may be five times what a fit makes of them
    likely_enough = workspace.score(loose) > workspace.score(current) - PRIOR_ODDS_LR
    if not (has_loose_file(loose.hypothesis) and likely_enough):
        return current
    return loose if workspace.find_relevant(loose, [reduced.hypothesis.model])[0] else current


def _find_explained(file: LooseFile, fit: Fit) -> Term | None:
    """The special effect that a loose file needs least, if it explains one."""
    special_terms = [term for term in fit.hypothesis.terms if term.id not in FILE_EFFECT_IDS]
    excess = [file.measure_loss(fit, term) - file.find_limit(term) for term in special_terms]
    return special_terms[excess.index(min(excess))] if excess and min(excess) <= 0.0 else None


def add_file_effects(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With all file effects that are worth their penalty beside each other."""
    proposal = LooseFile(workspace).propose(current)
    if proposal is None:
        return current
    trial = workspace.fit(proposal)
    return trial if workspace.score(trial) > workspace.score(current) else current


def fix_gain(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With the file's gain of the thrusters, where other numbers of the file explain as much."""
    trial = without_gain(workspace, current)
    return trial if trial and workspace.score(trial) > workspace.score(current) else current


def without_gain(workspace: SearchWorkspace, current: Fit) -> Fit | None:
    """Other numbers of a loose file in the place of a common gain; None where none was fitted."""
    gain = mark_gain(current.hypothesis)
    if not (has_loose_file(current.hypothesis) and gain.any()):
        return None
    fit = workspace.fit(drop_parameters(current.hypothesis, gain))
    return prune(workspace, add_file_effects(workspace, fit))
