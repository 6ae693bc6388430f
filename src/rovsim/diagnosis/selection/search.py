"""Which effects are missing: add the most likely one, refit all, try to swap, drop what is idle."""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.observer.hypothesis import Hypothesis, Term
from rovsim.diagnosis.observer.windows import window_errors
from rovsim.diagnosis.selection.fit import Fit
from rovsim.diagnosis.selection.workspace import Desk, Proposal, chance, proposals
from rovsim.dynamics.model import Model

ROUNDS = 3  # of trials, when none of the first matters
SURE = 6.0  # twice a log likelihood: odds of 20 to 1
SWAP = 1.0  # in twice the log likelihood: less is not worth another name
CLOSE = 0.2  # of the best predicted gain: less has never turned out best after refitting


def pruned(desk: Desk, current: Fit) -> Fit:
    """Without free parameters that are not worth their price, one at a time."""
    while len(current.hypothesis.x):
        smaller = _weakest_dropped(desk, current)
        if smaller is None:
            return current
        trial = desk.fit(smaller)
        if desk.score(trial) < desk.score(current):
            return current
        current = trial
    return current


def _weakest_dropped(desk: Desk, current: Fit) -> Hypothesis | None:
    """The hypothesis without its least certain parameter that starts from absence."""
    h, k, weakest, least = current.hypothesis, 0, None, 2.0 * desk.price
    for i, term in enumerate(h.terms):
        for p in term.parameters:
            z = (h.x[k] - p.default / p.scale) / max(current.std[k], 1e-12)
            k += 1
            if z**2 < least:
                smaller = _without_parameter(h, i, p.name)
                weakest, least = smaller, z**2
    return weakest


def _without_parameter(h: Hypothesis, i: int, name: str) -> Hypothesis:
    weak = [(k, n) == (i, name) for k, term in enumerate(h.terms) for n in term.free]
    return without_parameters(h, np.array(weak))


def without_parameters(h: Hypothesis, weak: Array) -> Hypothesis:
    """The hypothesis without some of its free parameters (k,), and without terms that have none.

    An effect that is not absent at its defaults stays or goes as a whole: it goes with the last.
    """
    terms = []
    for term, own in zip(h.terms, h.columns, strict=True):
        idle = {name for name, k in zip(term.free, own, strict=True) if weak[k]}
        defaults = {p.name: p.default for p in term.parameters if p.name in idle}
        left = tuple(name for name in term.free if name not in idle)
        if left and (not idle or {} in term.effect.starts):
            terms.append(Term(term.effect.with_values(defaults), left))
    return Hypothesis(h.base, tuple(terms))


def promising(desk: Desk, current: Fit) -> list[Proposal]:
    """The proposals that should gain something."""
    return [p for p in proposals(desk, current) if p.gain > 0.0]


def close(ranked: Sequence[Proposal], trials: int) -> list[Proposal]:
    """The first proposals, as far as they could turn out best once refitted."""
    return [p for p in ranked[:trials] if p.gain > CLOSE * ranked[0].gain]


def forward(desk: Desk, current: Fit, threshold: float) -> Fit | None:
    """The best single addition, refitted and pruned; None when none beats chance and matters."""
    left = promising(desk, current)
    for _ in range(ROUNDS):
        trying = close(left, desk.settings.trials)
        left = [p for p in left if p not in trying]
        tried = [desk.fit(current.hypothesis.with_term(p.term)) for p in trying]
        for best in sorted(tried, key=desk.score, reverse=True):
            if desk.score(best) - desk.score(current) < threshold:
                break
            if matters(desk, best, [current.hypothesis.model])[0]:
                return pruned(desk, best)
    return None


def matters(desk: Desk, found: Fit, without: Sequence[Model]) -> Array:
    """Whether some axis' error in 2 s windows is noticeably larger with each other model (m,)."""
    between, watches = desk.observatory.between, desk.observatory.watches
    rmse, _ = window_errors([found.hypothesis.model, *without], watches, between)
    return np.max(rmse[1:] / rmse[0], axis=1) - 1.0 > desk.settings.relevant


@dataclass(frozen=True)
class Rival:
    """An effect that could stand in for a selected one, and by how much it is less likely.

    `deficit` is in twice the log likelihood, prices paid: 6 are odds of 20 to 1.
    """

    effect: str
    instead_of: str
    deficit: float


def contested(desk: Desk, current: Fit, trials: int) -> tuple[Fit, list[Rival]]:
    """Replace any one term by another effect while that is more likely; then what comes close."""
    rivals = []
    for i, term in enumerate(current.hypothesis.terms):
        rest = desk.fit(current.hypothesis.without(i))
        for p in _others(desk, rest, term.id, trials):
            trial = desk.fit(rest.hypothesis.with_term(p.term))
            deficit = desk.score(current) - desk.score(trial)
            if deficit < -SWAP:
                return contested(desk, pruned(desk, trial), trials)
            rivals.append(Rival(p.term.id, term.id, deficit))
    return current, rivals


def _others(desk: Desk, rest: Fit, name: str, trials: int) -> list[Proposal]:
    """Other names for what a term took: one where it could win, or several to report."""
    ranked = promising(desk, rest)
    if trials == 1:
        return [p for p in close(ranked, 2) if p.term.id != name][:1]
    return close([p for p in ranked if p.term.id != name], trials)


def search(desk: Desk, base: Fit, seed: int) -> tuple[Desk, Fit, list[Rival]]:
    """From the base to the model to which nothing can be added, swapped or taken away.

    Also the desk as it is then: its noise and filters follow what is found. Rivals only where it
    came to an end before there were `most_effects`.
    """
    current, settings = base, desk.settings
    while len(current.hypothesis.terms) < settings.most_effects:
        by_chance = chance(desk, current, settings.draws, seed)
        threshold = max(0.0, float(np.quantile(by_chance, 1.0 - settings.false_alarm)))
        found = forward(desk, current, threshold)
        if found is None:
            break
        desk = desk.renewed(found)
        current, _ = contested(desk, desk.fit(found.hypothesis), 1)  # the likeliest other name
    else:
        return desk, current, []  # no end: these names are not what is missing
    return desk, *contested(desk, current, settings.trials)
