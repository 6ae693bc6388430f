"""Special effects judged beside all of a vehicle file that is off, fitted.

Beside what was selected of a file alone, numbers that were left as they are fix the factor that all
forces and inertia share, and a rarer effect may make up for that: a payload a metre above a vehicle
for thrusters 11 % stronger, couplings of the added mass for a payload. To first order that is not
seen, for such a factor is too large a step.
"""

from typing import Iterator, NamedTuple

import numpy as np

from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.selection import uncertain_file
from rovsim.diagnosis.selection.fit import Fit
from rovsim.diagnosis.selection.nominal_terms import STATED, is_off
from rovsim.diagnosis.selection.promising import find_swaps
from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.whole_file_fit import fit_whole_file, measure_misfit
from rovsim.diagnosis.selection.workspace import Removed, SearchWorkspace

# Times its limit: to first order a term may seem to take far more than it does once all of the file
# is fitted (137 for 1 of a limit of 60, 401 for less than 0 of one of 31).
WORTH_FITTING = 30.0


class Alternative(NamedTuple):
    """What may hold without a special effect, and what its own must take away beside the file."""

    start: Hypothesis
    limit: float


def judge_beside_file(workspace: SearchWorkspace, current: Fit) -> Fit:
    """With what holds in the place of each special effect beside all of a file that is off."""
    if not is_off(current.hypothesis):
        return current
    _, own = _fit_beside(workspace, current.hypothesis)
    rests = workspace.remove_each(current)
    for term, rest in zip(current.hypothesis.terms, rests, strict=True):
        limit = uncertain_file.find_limit(workspace, term)
        for other in _list_alternatives(workspace, current, term, rest):
            fitted, misfit = _fit_beside(workspace, other.start)
            if misfit + other.limit < own + limit:
                return judge_beside_file(workspace, prune(workspace, workspace.fit(fitted)))
    return current


def _list_alternatives(
    workspace: SearchWorkspace, current: Fit, term: Term, rest: Removed
) -> Iterator[Alternative]:
    """The file alone, or another special effect, where these should explain nearly as much."""
    if term.id in STATED:
        return
    hopeless = WORTH_FITTING * uncertain_file.find_limit(workspace, term)
    if uncertain_file.measure_loss(workspace, current, term) < hopeless:
        yield Alternative(rest.hypothesis, 0.0)
    for p in find_swaps(workspace, term, rest, workspace.settings.trials):
        if p.term.id in STATED or rest.ss_increase - p.net_decrease > hopeless:
            continue
        with_it = rest.hypothesis.with_term(p.term)
        yield Alternative(with_it, uncertain_file.find_limit(workspace, p.term))


def _fit_beside(workspace: SearchWorkspace, start: Hypothesis) -> tuple[Hypothesis, float]:
    """A hypothesis with all of the file, fitted, and its misfit; infinite where it diverges."""
    whole = fit_whole_file(start, workspace.bank, workspace.noise)
    if whole is None:
        return start, np.inf
    return whole.hypothesis, measure_misfit(whole, start)
