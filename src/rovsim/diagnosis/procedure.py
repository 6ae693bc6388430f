"""Diagnosis: which physical effects a model lacks, how sure that is, and what is left unexplained.

filter bank     the base model runs along the train runs, corrected by a filter
sensitivities   how each candidate would change what the filter could not foresee
search          add, refit, swap, prune; against what chance gives to the best of all candidates
held out        an addition must help on blocks it was not fitted to, and matter in 2 s windows
joint fit       where the search came to no end: all that could be wrong, together, then pruned
structure       what is left, and no candidate explains
replay fit      where there is some: values that replay best, rather than foresee the next reading
test runs       opened once, for the errors that are reported
"""

from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np

from rovsim.diagnosis.checks.residual import Structure
from rovsim.diagnosis.checks.residual_structure import find_structure
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.noise import FIRST_NOISE
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.observer.usable_runs import UsableRuns, select_usable
from rovsim.diagnosis.selection.candidates import list_candidates
from rovsim.diagnosis.selection.forward_selection import search
from rovsim.diagnosis.selection.gauss_newton import REACH, Fit, fit
from rovsim.diagnosis.selection.held_out import drop_idle
from rovsim.diagnosis.selection.joint_fit import fit_jointly
from rovsim.diagnosis.selection.ranking import Ranked, Selected, rank_alone, rank_selected
from rovsim.diagnosis.selection.replay_fit import fit_to_replays
from rovsim.diagnosis.selection.rivals import Rival, Selection
from rovsim.diagnosis.selection.sensitivities import fit_remaining_noise, linearise_candidates
from rovsim.diagnosis.selection.workspace import SearchWorkspace
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.results.diagnosis import Verdict

Stages = Callable[[str], None]

POLISHED = 2  # times: the noise of the first is already the right one


@dataclass(frozen=True, eq=False)
class TrainDiagnosis:
    """What was found on the train runs.

    `still` axes that nobody moved; `seconds` that could be used; `fit` of the base and all selected
    effects, None where there was too little to judge.
    """

    base: Model
    still: Sequence[str]
    seconds: float
    fit: Fit | None = None
    selected: Sequence[Selected] = ()
    ranking: Sequence[Ranked] = ()
    rivals: Sequence[Rival] = ()
    structures: Sequence[Structure] = ()

    @property
    def enough(self) -> bool:
        """Whether there was enough to judge anything."""
        return self.fit is not None

    @property
    def verdict(self) -> Verdict:
        """One of the four of the contract."""
        if not self.enough:
            return "insufficient_data"
        if self.structures:
            return "unexplained"
        if self.selected:
            return "missing_effects"
        return "insufficient_data" if self.still else "adequate"

    def models(self) -> list[Model]:
        """The base, then one model more for each selected effect."""
        found = [self.base]
        for one in self.selected:
            found.append((found[-1] + one.term.effect).called(f"+{one.term.id}"))
        return found


def diagnose(
    base: Model,
    train: Sequence[ObservedRun],
    settings: SearchSettings,
    *,
    catalogue: Catalogue,
    seed: int = 0,
    stage: Stages = lambda name: None,
) -> TrainDiagnosis:
    """Find what a model lacks on the train runs of a campaign."""
    usable = select_usable(train)
    if not usable.enough:
        return TrainDiagnosis(base, usable.still, usable.seconds)
    stage("observing")
    workspace = _observe(base, usable, settings, catalogue)
    nothing = workspace.fit(Hypothesis(base))
    stage("searching")
    selection = search(workspace, nothing, seed)
    stage("checking")
    selection = _check(selection, base, usable)
    found, structures = _settle(selection)
    rivals = selection.named_rivals
    return TrainDiagnosis(
        base, usable.still, usable.seconds, found,
        selected=rank_selected(found, rivals, usable.runs),
        ranking=rank_alone(workspace, nothing, found),
        rivals=rivals, structures=structures,
    )  # fmt: skip


def _observe(
    base: Model, usable: UsableRuns, settings: SearchSettings, catalogue: Catalogue
) -> SearchWorkspace:
    """Columns of the candidates, and the noise that is left when all of them may act at once.

    The columns are made with filters that take all the base misses for noise: these hold it close
    to the measurement. The filters of the search then suit the noise that was found.
    """
    first = FilterBank.design(usable.runs, base, FIRST_NOISE)
    noise, _ = first.fit_noise([e[0] for e in first.evaluate([base])], FIRST_NOISE)
    close = first.redesign(base, noise)
    candidates = list_candidates(usable.runs, catalogue)
    sensitivities = linearise_candidates(close, Hypothesis(base), candidates)
    noise = fit_remaining_noise(sensitivities, Hypothesis(base), noise)
    return SearchWorkspace(close.redesign(base, noise), sensitivities, noise, settings)


def _check(selection: Selection, base: Model, usable: UsableRuns) -> Selection:
    """What of a selection stands; all that could be wrong, where it came to no end."""
    if selection.complete:
        return drop_idle(selection)
    return fit_jointly(selection.workspace, base, usable.moved)


def _settle(selection: Selection) -> tuple[Fit, list[Structure]]:
    """The final values, and all that they leave unexplained."""
    found, bank = _polish(selection)
    structures = find_structure(found, bank)
    if structures and found.hypothesis.terms:
        found = fit_to_replays(found, bank)
    return found, structures


def _polish(selection: Selection) -> tuple[Fit, FilterBank]:
    """Fitted once more under its own noise, with filters that suit it and the model's damping."""
    found, bank = selection.found, selection.workspace.bank
    reach = np.inf if selection.complete else REACH
    for _ in range(POLISHED):
        bank = selection.workspace.bank.redesign(found.hypothesis.model, found.noise)
        found = fit(found.hypothesis, bank, found.noise, reach)
    return found, bank
