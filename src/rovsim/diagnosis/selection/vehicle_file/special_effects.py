"""Special effects judged beside all of a loose vehicle file, fitted.

Beside what was selected of a file alone, numbers that were left as they are fix the factor that all
forces and inertia share, and a rarer effect may make up for that: a payload a metre above a vehicle
for thrusters 11 % stronger, couplings of the added mass for a payload. To first order that is not
seen, for such a factor is too large a step: it promised a loss of 3754 where none was.
"""

from typing import Iterator, NamedTuple

import numpy as np

from rovsim.diagnosis.selection.first_order import Removed
from rovsim.diagnosis.selection.promising import find_swaps
from rovsim.diagnosis.selection.pruning import prune
from rovsim.diagnosis.selection.search_result import Rival
from rovsim.diagnosis.selection.thresholds import add_term
from rovsim.diagnosis.selection.vehicle_file.loose_file import LooseFile
from rovsim.diagnosis.selection.vehicle_file.whole_file import fit_whole_file, measure_misfit
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.dynamics.effects.thrusters import ThrusterGain
from rovsim.estimation.file_effects import FILE_EFFECT_IDS, has_loose_file
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.hypothesis import Hypothesis, Term

# Times its limit, to first order: another effect that leaves more in its place is not fitted.
MAX_LOSS_FACTOR = 30.0


class Alternative(NamedTuple):
    """What may hold without a special effect, and what its own must take away beside the file."""

    name: str
    start: Hypothesis
    limit: float


class Judged(NamedTuple):
    """What holds, and what else each special effect could be, beside all of the file."""

    fit: Fit
    rivals: tuple[Rival, ...] = ()


def judge_beside_file(
    workspace: SearchWorkspace, current: Fit, gone: frozenset[str] = frozenset()
) -> Judged:
    """With what holds in the place of each special effect beside all of a loose file.

    `gone`: effects that had to go already, and do not come back: so this ends.
    """
    ids = {term.id for term in current.hypothesis.terms}
    if not has_loose_file(current.hypothesis) or ids <= {*FILE_EFFECT_IDS}:
        return Judged(current)
    _, current_misfit = _fit_beside(workspace, current.hypothesis)
    if np.isinf(current_misfit):
        return Judged(current)
    file, rivals = LooseFile(workspace), []
    removals = workspace.first_order.remove_each(current)
    for term, removed in zip(current.hypothesis.terms, removals, strict=True):
        limit = file.find_limit(term)
        for alternative in _list_alternatives(file, term, removed):
            if alternative.name in gone:
                continue
            fit, misfit = _fit_beside(workspace, alternative.start)
            deficit = misfit + alternative.limit - current_misfit - limit
            if fit is not None and deficit < 0.0:
                pruned = prune(workspace, workspace.fit(fit.hypothesis))
                return judge_beside_file(workspace, pruned, gone | {term.id})
            if alternative.name not in ids:
                rivals.append(Rival(alternative.name, term.id, deficit, fit))
    return Judged(current, tuple(rivals))


def _list_alternatives(file: LooseFile, term: Term, rest: Removed) -> Iterator[Alternative]:
    """The file alone, or another special effect, where these should explain nearly as much.

    The file is called by the gain of the thrusters: without that, the rest of it was free before.
    """
    if term.id in FILE_EFFECT_IDS:
        return
    yield Alternative(ThrusterGain.id, rest.hypothesis, 0.0)
    workspace, largest_loss = file.workspace, MAX_LOSS_FACTOR * file.find_limit(term)
    for p in find_swaps(workspace, term, rest, workspace.settings.trials):
        if p.term.id in FILE_EFFECT_IDS or rest.ss_increase - p.net_decrease > largest_loss:
            continue
        start = add_term(workspace, rest.hypothesis, p.term)
        yield Alternative(p.term.id, start, file.find_limit(p.term))


def _fit_beside(workspace: SearchWorkspace, start: Hypothesis) -> tuple[Fit | None, float]:
    """A hypothesis with all of the file, fitted, and its misfit; infinite where it diverges."""
    fit = fit_whole_file(start, workspace.bank, workspace.noise)
    return fit, np.inf if fit is None else measure_misfit(fit, start)
