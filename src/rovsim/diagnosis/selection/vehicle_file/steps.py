"""What the vehicle file, where it is off anyway, explains as well as something that is rarer."""

from rovsim.diagnosis.observer.hypothesis import Term
from rovsim.diagnosis.selection.fit import Fit
from rovsim.diagnosis.selection.pruning import drop_parameters, prune
from rovsim.diagnosis.selection.search_result import MIN_LR_APART
from rovsim.diagnosis.selection.vehicle_file import uncertain_file
from rovsim.diagnosis.selection.vehicle_file.stated import STATED, is_off, mark_gain
from rovsim.diagnosis.selection.workspace import SearchWorkspace


def prefer_file(workspace: SearchWorkspace, current: Fit) -> Fit:
    """Without effects that the vehicle file, where it is off anyway, explains about as well."""
    terms = current.hypothesis.terms
    if not any(term.id in STATED for term in terms):
        return current
    for term in terms:
        if uncertain_file.explains(workspace, current, term.id):
            rest = workspace.fit(workspace.drop(current, [(term,)])[0])
            fewer = prune(workspace, add_file(workspace, rest))
            if _is_as_good(workspace, fewer, current, term):
                return prefer_file(workspace, fewer)
    return current


def _is_as_good(workspace: SearchWorkspace, fewer: Fit, current: Fit, term: Term) -> bool:
    """Whether more of the file makes up for a special term, as far as such a term is rare."""
    if not is_off(current.hypothesis):
        return workspace.score(fewer) > workspace.score(current) - uncertain_file.FILE_LR
    costs = [uncertain_file.measure_cost(workspace, one) for one in (fewer, current)]
    return costs[0] - costs[1] <= uncertain_file.find_limit(workspace, term)


def suspect_file(workspace: SearchWorkspace, current: Fit) -> Fit:
    """From where to search on, if the file is likelier to be off everywhere than right.

    Where each number of a file is a little off, none may be worth its penalty beside a special
    effect that takes what several of them would explain together. So the file as a whole competes
    with all special effects that it explains. It must be noticed, too: fins a tenth weaker, which
    nobody would notice, were three effects of the file at a probability of 0.997.
    """
    if is_off(current.hypothesis):
        return current
    rest = current
    while explained := _find_explained(workspace, rest):
        rest = workspace.fit(workspace.drop(rest, [(explained,)])[0])
    doubt = uncertain_file.measure_doubt(workspace, rest)
    if workspace.score(rest) + doubt < workspace.score(current) + MIN_LR_APART:
        return current
    loose = add_file(workspace, rest)
    # first-order predictions of many numbers together may be five times what a fit makes of them
    kept = workspace.score(loose) > workspace.score(current) - uncertain_file.FILE_LR
    if not (is_off(loose.hypothesis) and kept):
        return current
    return loose if workspace.find_relevant(loose, [rest.hypothesis.model])[0] else current


def _find_explained(workspace: SearchWorkspace, fit: Fit) -> Term | None:
    """The special effect that a loose file needs least, if it explains one."""
    special = [term for term in fit.hypothesis.terms if term.id not in STATED]
    beyond = [
        uncertain_file.measure_loss(workspace, fit, term)
        - uncertain_file.find_limit(workspace, term)
        for term in special
    ]
    return special[beyond.index(min(beyond))] if beyond and min(beyond) <= 0.0 else None


def add_file(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With all that the vehicle file states and that is worth its penalty."""
    wanted = uncertain_file.propose_file(workspace, current)
    if wanted is None:
        return current
    trial = workspace.fit(wanted)
    return trial if workspace.score(trial) > workspace.score(current) else current


def fix_gain(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With the file's gain of the thrusters, where other numbers of the file explain as much."""
    gain = mark_gain(current.hypothesis)
    if not (is_off(current.hypothesis) and gain.any()):
        return current
    rest = workspace.fit(drop_parameters(current.hypothesis, gain))
    other = prune(workspace, add_file(workspace, rest))
    return other if workspace.score(other) > workspace.score(current) else current
