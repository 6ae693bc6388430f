"""Diagnosis: which physical effects a model lacks, how sure that is, and what is left unexplained.

observe      the base model runs along the train runs, corrected by a filter (observe, noise)
library      how each candidate would change what the filter could not foresee
search       add, refit, swap, prune; against what chance gives to the best of all candidates
held out     an addition must help on blocks it was not fitted to, and matter in 2 s windows
leftover     structure that no candidate explains
test runs    opened once, for the errors that are reported
"""

from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim import AXES
from rovsim.diagnosis.candidates import candidates
from rovsim.diagnosis.desk import Desk, Proposal, proposals
from rovsim.diagnosis.evidence import Observatory
from rovsim.diagnosis.fit import Fit, fit
from rovsim.diagnosis.heldout import held_out_gain
from rovsim.diagnosis.hypothesis import Hypothesis, Term
from rovsim.diagnosis.leftover import Structure, leftover
from rovsim.diagnosis.library import Library, library, remaining_noise
from rovsim.diagnosis.noise import Noise
from rovsim.diagnosis.search import Rival, matters, search
from rovsim.diagnosis.settings import SearchSettings
from rovsim.diagnosis.stretched import unstretched
from rovsim.diagnosis.watch import Watch
from rovsim.diagnosis.windows import window_errors
from rovsim.model import Model
from rovsim.recording.quality import EXCITED
from rovsim.thrust import Between

Stages = Callable[[str], None]

# Turbulence that moves this vehicle by some mm/s2, and a usual motion capture: only a first guess.
FIRST_NOISE = Noise(
    np.array([0.02] * 3 + [0.05] * 3), np.ones(6), np.array([1e-3] * 3 + [3e-3] * 3)
)
POLISHED = 2  # times: the noise of the first is already the right one
SHORTEST = 10.0  # s of settled readings; less does not tell noise from physics


@dataclass(frozen=True, eq=False)
class Selected:
    """A selected effect, the share of the base's error that it removes, how sure its name is."""

    term: Term
    std: dict[str, float]
    error_reduction: float
    probability: float


@dataclass(frozen=True, eq=False)
class Ranked:
    """One effect by itself on top of the base."""

    term: Term
    error_reduction: float
    probability: float


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
    found, strange = unstretched(last, _checked(last, found))
    rivals = [r for r in rivals if r.instead_of in {t.id for t in found.hypothesis.terms}]
    found, observatory = _polished(found, last.observatory)
    structures = [*strange, *_leftover(found, observatory)]
    return Diagnosis(
        base, found, _selected(found, rivals, watches, between),
        _ranking(desk, nothing, alone, found), rivals, structures, still, seconds,
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


def _polished(found: Fit, observatory: Observatory) -> tuple[Fit, Observatory]:
    """Fitted once more under its own noise, with filters that suit it and the model's damping."""
    fresh = observatory
    for _ in range(POLISHED):
        fresh = observatory.suiting(found.hypothesis.model, found.noise)
        found = fit(found.hypothesis, fresh, found.noise)
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


def _selected(found: Fit, rivals, watches, between) -> list[Selected]:
    """Selected effects, the one that removes most error first, then the next on top of it."""
    left, order, errors = list(range(len(found.hypothesis.terms))), [], []
    model = found.hypothesis.base
    start = _error([model], watches, between)[0]
    now = start
    while left:
        tried = [model + found.hypothesis.terms[i].effect for i in left]
        after = _error(tried, watches, between)
        best = int(np.argmin(after))
        order.append(left.pop(best))
        errors.append((now - after[best]) / start)
        model, now = tried[best], after[best]
    return [
        Selected(
            found.hypothesis.terms[i], _std(found, i), float(gain), _probability(found, i, rivals)
        )
        for i, gain in zip(order, errors, strict=True)
    ]


def _error(models, watches, between) -> Array:
    return np.array(
        [np.nan if e is None else e for e in window_errors(models, watches, between)[1]]
    )


def _std(found: Fit, i: int) -> dict[str, float]:
    """Standard deviations by name; within its grain a value could be anywhere (uniform: / √12)."""
    term, columns = found.hypothesis.terms[i], found.hypothesis.columns[i]
    return {
        p.name: float(np.hypot(found.std[k] * p.scale, p.grain / np.sqrt(12.0)))
        for p, k in zip(term.parameters, columns, strict=True)
    }


def _probability(found: Fit, i: int, rivals: Sequence[Rival]) -> float:
    """Of this name among all that were tried in its place, from their likelihoods."""
    name = found.hypothesis.terms[i].id
    odds = sum(np.exp(-0.5 * min(r.deficit, 700.0)) for r in rivals if r.instead_of == name)
    return float(1.0 / (1.0 + odds))


def _ranking(desk: Desk, nothing: Fit, alone: Sequence[Proposal], found: Fit) -> list[Ranked]:
    """Every effect by itself: those refitted first, by their likelihood, then the others' promise.

    The probability is that of the name if one effect alone is missing, or none.
    """
    named = {term.id for term in found.hypothesis.terms}
    starts = [(p, nothing.hypothesis.with_term(p.term)) for p in alone]
    fits = [desk.fit(h) for p, h in starts if p.term.id in named or desk.knows(h)]
    fits.sort(key=desk.score, reverse=True)
    terms = [one.hypothesis.terms[0] for one in fits]
    terms += [p.term for p in alone if p.term.id not in {term.id for term in terms}]
    gain = np.array([0.5 * (desk.score(one) - desk.score(nothing)) for one in fits])
    weight = np.exp(gain - np.max(gain, initial=0.0))
    share = weight / (weight.sum() + np.exp(-np.max(gain, initial=0.0)))
    observatory, base = desk.observatory, nothing.hypothesis.base
    models = [base, *(base + term.effect for term in terms)]
    error = _error(models, observatory.watches, observatory.between)
    sure = np.append(share, np.zeros(len(terms) - len(fits)))
    return [
        Ranked(term, float(max(0.0, 1.0 - e / error[0])), float(p))
        for term, e, p in zip(terms, error[1:], sure, strict=True)
    ]
