"""Diagnosis: which physical effects a model lacks, how sure that is, and what is left unexplained.

observe      the base model runs along the train runs, corrected by a filter (observe, noise)
library      how each candidate would change what the filter could not foresee
search       add, refit, swap, prune; against what chance gives to the best of all candidates
held out     an addition must help on blocks it was not fitted to, and matter in 2 s windows
at once      where the search came to no end: all that could be wrong, together, then pruned
leftover     structure that no candidate explains
replayed     where there is some: values that replay best, rather than foresee the next reading
test runs    opened once, for the errors that are reported
"""

from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np

from rovsim import AXES
from rovsim.diagnosis.checks.imitation import unstretched
from rovsim.diagnosis.checks.residual_structure import Structure, leftover
from rovsim.diagnosis.observer.filter_bank import Observatory
from rovsim.diagnosis.observer.hypothesis import Hypothesis
from rovsim.diagnosis.observer.noise import Noise
from rovsim.diagnosis.observer.observed_run import Watch
from rovsim.diagnosis.selection.candidates import candidates
from rovsim.diagnosis.selection.fit import REACH, Fit, fit
from rovsim.diagnosis.selection.held_out import held_out_gain
from rovsim.diagnosis.selection.joint_fit import at_once
from rovsim.diagnosis.selection.ranking import Ranked, Selected, ranking, selected
from rovsim.diagnosis.selection.replay_fit import replayed
from rovsim.diagnosis.selection.search import Rival, matters, search
from rovsim.diagnosis.selection.sensitivities import Library, library, remaining_noise
from rovsim.diagnosis.selection.workspace import Desk, proposals
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
    train: Sequence[Watch],
    settings: SearchSettings,
    between: Between,
    seed: int = 0,
    stage: Stages = lambda name: None,
) -> Diagnosis:
    """Find what a model lacks on the train runs of a campaign."""
    watches, still, seconds = usable(train)
    if not enough(still, seconds):
        return Diagnosis(base, None, [], [], [], [], still, seconds)
    stage("observing")
    observatory, known, noise = _observed(base, watches, between)
    desk = Desk(observatory, known, noise, settings)
    nothing = desk.fit(Hypothesis(base))
    alone = proposals(desk, nothing)
    stage("searching")
    last, found, rivals = search(desk, nothing, seed)
    stage("checking")
    strange: list[Structure] = []
    reach = np.inf
    if len(found.hypothesis.terms) < settings.most_effects:
        found, strange = unstretched(last, _checked(last, found))
    else:
        last, found, rivals = at_once(last, base, still)
        reach = REACH
    rivals = [r for r in rivals if r.instead_of in {t.id for t in found.hypothesis.terms}]
    found, observatory = _polished(found, last.observatory, reach)
    structures = [*strange, *_leftover(found, observatory)]
    if structures and found.hypothesis.terms:
        found = replayed(found, observatory)
    return Diagnosis(
        base, found, selected(found, rivals, watches, between),
        ranking(desk, nothing, alone, found), rivals, structures, still, seconds,
    )  # fmt: skip


def usable(train: Sequence[Watch]) -> tuple[list[Watch], list[str], float]:
    """Runs with something to observe, axes that none of them moved, and how many seconds count."""
    watches = [w for w in train if len(w.spans)]
    seconds = float(sum(w.settled.sum() * w.period for w in watches))
    return watches, not_excited(watches), seconds


def enough(still: Sequence[str], seconds: float) -> bool:
    """Whether anything can be judged."""
    return seconds >= SHORTEST and len(still) < len(AXES)


def not_excited(watches: Sequence[Watch]) -> list[str]:
    """Axes that no train run moved: nothing can be said about them."""
    moved = np.zeros(len(AXES), bool)
    for one in watches:
        moved |= np.std(one.motion.nu[one.motion.usable], axis=0) > EXCITED
    return [axis for axis, yes in zip(AXES, moved, strict=True) if not yes]


def _observed(base: Model, watches, between) -> tuple[Observatory, Library, Noise]:
    """Columns of the candidates, and the noise that is left when all of them may act at once.

    The columns are made with filters that take all the base misses for noise: these hold it close
    to the measurement. The filters of the search then suit the noise that was found.
    """
    first = Observatory.built(watches, base, FIRST_NOISE, between)
    noise, _ = first.noise([e[0] for e in first.innovations([base])], FIRST_NOISE)
    close = first.suiting(base, noise)
    known = library(close, Hypothesis(base), candidates(watches))
    noise = remaining_noise(known, Hypothesis(base), noise)
    return close.suiting(base, noise), known, noise


def _checked(desk: Desk, found: Fit) -> Fit:
    """Without effects that do not help on held-out blocks, or that no user would see."""
    while found.hypothesis.terms:
        h = found.hypothesis
        smaller = [desk.fit(h.without(i)) for i in range(len(h.terms))]
        noticed = matters(desk, found, [h.without(i).model for i in range(len(h.terms))])
        idle = [
            i
            for i, one in enumerate(smaller)
            if not noticed[i] or held_out_gain(found, one, desk.observatory) <= 0.0
        ]
        if not idle:
            break
        found = desk.fit(h.without(idle[-1]))  # the one that came last
    return found


def _polished(found: Fit, observatory: Observatory, reach: float) -> tuple[Fit, Observatory]:
    """Fitted once more under its own noise, with filters that suit it and the model's damping."""
    fresh = observatory
    for _ in range(POLISHED):
        fresh = observatory.suiting(found.hypothesis.model, found.noise)
        found = fit(found.hypothesis, fresh, found.noise, reach)
    return found, fresh


def _leftover(found: Fit, observatory: Observatory) -> list[Structure]:
    """Structure in the innovations of the final model."""
    counts = np.cumsum([int(w.settled.sum()) for w in observatory.watches])[:-1]
    white = observatory.white(found.e, found.noise)
    J = observatory.white(found.J, found.noise)
    return leftover(
        np.split(white, counts, axis=-1), np.split(J, counts, axis=-1), observatory.watches,
        observatory.tuned(found.noise), found.noise, found.hypothesis.model.thrust_path,
    )  # fmt: skip
