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

from rovsim import AXES
from rovsim.diagnosis.checks.imitation import drop_imitations
from rovsim.diagnosis.checks.residual_structure import Structure, find_structure
from rovsim.diagnosis.observer.filter_bank import FilterBank
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.diagnosis.selection.candidates import list_candidates
from rovsim.diagnosis.selection.forward_selection import Rival, find_relevant, search
from rovsim.diagnosis.selection.gauss_newton import REACH, Fit, fit
from rovsim.diagnosis.selection.held_out import cross_validate
from rovsim.diagnosis.selection.joint_fit import fit_jointly
from rovsim.diagnosis.selection.ranking import Ranked, Selected, rank_alone, rank_selected
from rovsim.diagnosis.selection.replay_fit import fit_to_replays
from rovsim.diagnosis.selection.sensitivities import (
    Sensitivities,
    fit_remaining_noise,
    linearise_candidates,
)
from rovsim.diagnosis.selection.workspace import SearchWorkspace, propose
from rovsim.diagnosis.settings import SearchSettings
from rovsim.dynamics.actuation import Between
from rovsim.dynamics.model import Model
from rovsim.measurement.recording.quality import EXCITED

Stages = Callable[[str], None]

# Turbulence that moves this vehicle by some mm/s2, and a usual motion capture: only a first guess.
FIRST_NOISE = Noise(
    np.array([0.02] * 3 + [0.05] * 3), np.ones(6), np.array([1e-3] * 3 + [3e-3] * 3)
)
POLISHED = 2  # times: the noise of the first is already the right one
SHORTEST = 10.0  # s of settled readings; less does not tell noise from physics


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What was found on the train runs.

    `fit` of the base and all selected effects, None where there was too little to judge; `still`
    axes that nobody moved; `seconds` that could be used.
    """

    base: Model
    fit: Fit | None
    selected: list[Selected]
    ranking: list[Ranked]
    rivals: list[Rival]
    structures: list[Structure]
    still: list[str]
    seconds: float

    @property
    def enough(self) -> bool:
        """Whether there was enough to judge anything."""
        return self.fit is not None

    @property
    def verdict(self) -> str:
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
    between: Between,
    seed: int = 0,
    stage: Stages = lambda name: None,
) -> Diagnosis:
    """Find what a model lacks on the train runs of a campaign."""
    runs, still, seconds = usable(train)
    if not enough(still, seconds):
        return Diagnosis(base, None, [], [], [], [], still, seconds)
    stage("observing")
    bank, sensitivities, noise = _observe(base, runs, between)
    workspace = SearchWorkspace(bank, sensitivities, noise, settings)
    nothing = workspace.fit(Hypothesis(base))
    alone = propose(workspace, nothing)
    stage("searching")
    last, found, rivals = search(workspace, nothing, seed)
    stage("checking")
    strange: list[Structure] = []
    reach = np.inf
    if len(found.hypothesis.terms) < settings.most_effects:
        found, strange = drop_imitations(last, _check(last, found))
    else:
        last, found, rivals = fit_jointly(last, base, still)
        reach = REACH
    rivals = [r for r in rivals if r.instead_of in {t.id for t in found.hypothesis.terms}]
    found, bank = _polish(found, last.bank, reach)
    structures = [*strange, *_check_structure(found, bank)]
    if structures and found.hypothesis.terms:
        found = fit_to_replays(found, bank)
    return Diagnosis(
        base, found, rank_selected(found, rivals, runs, between),
        rank_alone(workspace, nothing, alone, found), rivals, structures, still, seconds,
    )  # fmt: skip


def usable(train: Sequence[ObservedRun]) -> tuple[list[ObservedRun], list[str], float]:
    """Runs with something to observe, axes that none of them moved, and how many seconds count."""
    runs = [w for w in train if len(w.spans)]
    seconds = float(sum(w.settled.sum() * w.period for w in runs))
    return runs, find_unmoved(runs), seconds


def enough(still: Sequence[str], seconds: float) -> bool:
    """Whether anything can be judged."""
    return seconds >= SHORTEST and len(still) < len(AXES)


def find_unmoved(runs: Sequence[ObservedRun]) -> list[str]:
    """Axes that no train run moved: nothing can be said about them."""
    moved = np.zeros(len(AXES), bool)
    for one in runs:
        moved |= np.std(one.motion.nu[one.motion.usable], axis=0) > EXCITED
    return [axis for axis, yes in zip(AXES, moved, strict=True) if not yes]


def _observe(base: Model, runs, between) -> tuple[FilterBank, Sensitivities, Noise]:
    """Columns of the candidates, and the noise that is left when all of them may act at once.

    The columns are made with filters that take all the base misses for noise: these hold it close
    to the measurement. The filters of the search then suit the noise that was found.
    """
    first = FilterBank.design(runs, base, FIRST_NOISE, between)
    noise, _ = first.fit_noise([e[0] for e in first.evaluate([base])], FIRST_NOISE)
    close = first.redesign(base, noise)
    known = linearise_candidates(close, Hypothesis(base), list_candidates(runs))
    noise = fit_remaining_noise(known, Hypothesis(base), noise)
    return close.redesign(base, noise), known, noise


def _check(workspace: SearchWorkspace, found: Fit) -> Fit:
    """Without effects that do not help on held-out blocks, or that no user would see."""
    while found.hypothesis.terms:
        h = found.hypothesis
        smaller = [workspace.fit(h.without(i)) for i in range(len(h.terms))]
        noticed = find_relevant(workspace, found, [h.without(i).model for i in range(len(h.terms))])
        idle = [
            i
            for i, one in enumerate(smaller)
            if not noticed[i] or cross_validate(found, one, workspace.bank) <= 0.0
        ]
        if not idle:
            break
        found = workspace.fit(h.without(idle[-1]))  # the one that came last
    return found


def _polish(found: Fit, bank: FilterBank, reach: float) -> tuple[Fit, FilterBank]:
    """Fitted once more under its own noise, with filters that suit it and the model's damping."""
    fresh = bank
    for _ in range(POLISHED):
        fresh = bank.redesign(found.hypothesis.model, found.noise)
        found = fit(found.hypothesis, fresh, found.noise, reach)
    return found, fresh


def _check_structure(found: Fit, bank: FilterBank) -> list[Structure]:
    """Structure in the innovations of the final model."""
    counts = np.cumsum([int(w.settled.sum()) for w in bank.runs])[:-1]
    white = bank.whiten(found.e, found.noise)
    J = bank.whiten(found.J, found.noise)
    return find_structure(
        np.split(white, counts, axis=-1), np.split(J, counts, axis=-1), bank.runs,
        bank.tune(found.noise), found.noise, found.hypothesis.model.thrust_path,
    )  # fmt: skip
