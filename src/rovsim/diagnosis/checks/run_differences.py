"""Find an effect that has another value in each run.

A clock of the log that is set anew, a battery that was changed, ballast or a tether that was moved:
no single value is right for all runs, and what is left of each looks like unknown physics. To first
order, each such effect is fitted to each run by itself, with all else as it is. By how much more
that explains than one value for all runs is a likelihood-ratio statistic. A hull keeps its drag and
its added mass: vortices behind it were explained by a coupling in one run alone, of hundreds of N.
"""

from dataclasses import dataclass, replace
from typing import Iterator, Mapping, NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.checks.by_run import ProductsByRun, group_runs
from rovsim.diagnosis.selection.accepted_effects import find_std
from rovsim.diagnosis.selection.holdout_validation import HoldoutValidation
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.selection.workspace import HOPELESS_LR
from rovsim.diagnosis.structure.residual_structure import find_structure
from rovsim.estimation.fit import Fit, polish
from rovsim.estimation.fit import fit as fit_values
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.residual_source import Linearised

# Of the strongest structure: where more is left with a value for each run, these are not what
# differs. Runs differ a little in every effect that resembles unknown physics.
MAX_LEFT_SHARE = 0.5


class RunValues(NamedTuple):
    """An effect at the values of one run, and their standard deviations, in their units."""

    term: Term
    std: dict[str, float]


@dataclass(frozen=True)
class RunDifference:
    """An effect that has another value in each run.

    Attributes:
        by_run: its values in each, by the run's id.
        explains: whether these values explain most of what is left; else they were found without
            a model.
    """

    by_run: Mapping[str, RunValues]
    explains: bool = True

    @property
    def effect_id(self) -> str:
        """Id of the effect."""
        return next(iter(self.by_run.values())).term.id

    def values(self, parameter: str) -> dict[str, float]:
        """Values of one of its parameters, in its unit, by the run's id."""
        return {run: one.term.effect[parameter] for run, one in self.by_run.items()}


class _Differing(NamedTuple):
    """A term with those of its parameters free that differ, and the score of that."""

    term: Term
    score: float


def find_run_difference(selection: SearchResult) -> RunDifference | None:
    """Find the effect that runs differ in most; None where that leaves as much structure.

    A common value has to be less likely by a factor of e^50, as clocks and ballast that differ make
    it: what else may be wrong favours a difference a little.

    Args:
        selection: where a search ended.
    """
    fit, bank = selection.best, selection.workspace.bank
    runs = group_runs(bank.runs)
    if len(runs) < 2 or not fit.is_finite:
        return None
    best = max(_list_differing(selection, runs), key=lambda one: one.score, default=None)
    if best is None or best.score < HOPELESS_LR:
        return None
    linearised = linearise_term(fit, best.term, bank)
    e, J = (bank.whiten(x, fit.noise) for x in (fit.linearised.e, linearised))
    products = ProductsByRun.of(e, J, bank.runs)
    steps = products.steps
    innovations = [e.copy() for e in fit.linearised.e]
    for step, own in zip(steps, runs.values(), strict=True):
        for k in own:
            innovations[k] += np.tensordot(step, linearised[k], axes=1)
    if not _explains(replace(fit.linearised, e=innovations), fit, bank):
        return None
    starts = zip(runs.items(), steps, strict=True)
    return RunDifference(
        {run: _fit_one(fit, best.term, step, bank, own) for (run, own), step in starts}
    )


def find_harmful(accepted: Hypothesis, validation: HoldoutValidation) -> int | None:
    """Index of an accepted effect without which some run is surely replayed better; None if none.

    Args:
        accepted: the accepted effects, at values common to all runs.
        validation: judges replays; it knows the whole runs.
    """
    runs = validation.whole_runs
    judges = [replace(validation, runs=[runs[k] for k in own]) for own in group_runs(runs).values()]
    for i in range(len(accepted.terms)):
        without = accepted.without(i).model
        if any(judge.refuses(accepted.model, without) for judge in judges):
            return i
    return None


def _list_differing(
    selection: SearchResult, runs: Mapping[str, Sequence[int]]
) -> Iterator[_Differing]:
    """List the accepted effects and the candidates whose values differ from run to run."""
    fit, workspace = selection.best, selection.workspace
    h, bank, noise = fit.hypothesis, workspace.bank, fit.noise
    penalty = workspace.penalty * (len(runs) - 1)
    e = bank.whiten(fit.linearised.e, noise)
    accepted = bank.whiten(fit.linearised.J, noise)
    sensitivities = workspace.columns.sensitivities_at(h)
    rows = [
        (term, accepted[own])
        for term, own in zip(h.terms, h.columns, strict=True)
        if term.effect.differs_between_runs
    ]
    for block in sensitivities.blocks:
        effect, own = block.candidate.effect, list(block.derivatives)
        is_new = effect.id not in {term.id for term in h.terms}
        if effect.differs_between_runs and block.secant is None and is_new:
            columns = [of_run[own] for of_run in sensitivities.columns]
            term = block.candidate.term(block.candidate.sloped)
            rows.append((term, sensitivities.bank.whiten(columns, noise)))
    for term, derivatives in rows:
        products = ProductsByRun.of(e, derivatives, bank.runs)
        kept = choose_differing(products, penalty)
        if kept:
            score = products.only(kept).difference - penalty * len(kept)
            yield _Differing(replace(term, free=tuple(term.free[k] for k in kept)), score)


def choose_differing(products: ProductsByRun, penalty: float) -> list[int]:
    """Which derivatives have other steps in each run, each of them worth its penalty.

    Found one by one, or left when the idle ones are gone, whichever explains more: of thrusters
    and the sum of all, elimination loses the sum first, since any one of these can be missed.

    Args:
        products: of all derivatives.
        penalty: of each that differs.
    """

    def score(kept: list[int]) -> float:
        return products.only(kept).difference - penalty * len(kept) if kept else 0.0

    return max(_eliminate(products, penalty), _add_up(products, penalty), key=score)


def _acting(products: ProductsByRun) -> list[int]:
    return [int(k) for k in np.flatnonzero(np.einsum("rkk->k", products.gram) > 0.0)]


def _add_up(products: ProductsByRun, penalty: float) -> list[int]:
    """From none, each time the derivative that explains most, as long as it is worth it."""
    kept, explained = list[int](), 0.0
    while rest := [k for k in _acting(products) if k not in kept]:
        wholes = {k: products.only([*kept, k]).difference for k in rest}
        best = max(rest, key=wholes.__getitem__)
        if wholes[best] - explained < penalty:
            break
        kept, explained = [*kept, best], wholes[best]
    return sorted(kept)


def _eliminate(products: ProductsByRun, penalty: float) -> list[int]:
    """From all derivatives down to those that are worth their penalty."""
    kept = _acting(products)
    while kept:
        whole = products.only(kept).difference
        worth = [
            whole - products.only([j for j in kept if j != k]).difference
            if len(kept) > 1
            else whole
            for k in kept
        ]
        weakest = int(np.argmin(worth))
        if worth[weakest] >= penalty:
            break
        kept.pop(weakest)
    return kept


def linearise_term(fit: Fit, term: Term, bank: FilterBank) -> list[Array]:
    """Derivatives (k, 6, n) of each run to the free parameters of a term, accepted or not."""
    h, linearised = fit.hypothesis, fit.linearised
    if term.id not in {accepted.id for accepted in h.terms}:
        linearised = bank.linearise(h.with_term(term))
    names = linearised.hypothesis.parameter_names
    rows = [names.index(f"{term.id}.{name}") for name in term.free]
    return [J[rows] for J in linearised.J]


def _explains(with_steps: Linearised, fit: Fit, bank: FilterBank) -> bool:
    """Whether values of each run leave at most half of the strongest structure."""
    strongest, left = (
        max((s.times_limit for s in find_structure(one, bank)), default=0.0)
        for one in (fit, replace(fit, linearised=with_steps))
    )
    return bool(left <= MAX_LEFT_SHARE * strongest)


def _fit_one(
    common: Fit, term: Term, step: Array, bank: FilterBank, own: Sequence[int]
) -> RunValues:
    """Fit a term to one run, with all other effects at their common values.

    Args:
        common: the fit to all runs.
        term: with its parameters that differ free, at their common values.
        step: of these (k,), scaled: where the fit begins.
        bank: of all runs.
        own: places in it of the parts of the run.
    """
    others = common.hypothesis.without_effect(term.id).model
    start = Hypothesis(others, (term.at(term.x + step),))
    runs, noise = [bank.runs[k] for k in own], common.noise.of_runs(own)
    alone = fit_values(start, FilterBank.design(runs, start.model, noise), noise)
    fit, _ = polish(alone, runs)
    return RunValues(fit.hypothesis.terms[0], find_std(fit, 0))
