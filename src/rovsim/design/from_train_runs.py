"""Fit what a question needs to the train runs: one hypothesis, or two rivals."""

from dataclasses import replace
from typing import Sequence

import numpy as np

from rovsim.core.errors import BadInput, nearest
from rovsim.design.prior_information import FittedHypothesis, PriorInformation
from rovsim.design.settings import Question
from rovsim.diagnosis.selection.first_order import FirstOrder
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect
from rovsim.dynamics.model import Model
from rovsim.estimation.candidates import Candidate, list_candidates
from rovsim.estimation.fit import PRIOR_STD, Fit, fit, polish
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.least_squares import gram
from rovsim.estimation.observer.noise import FIRST_NOISE
from rovsim.estimation.observer.observed_run import ObservedRun
from rovsim.estimation.sensitivities import linearise_candidates
from rovsim.estimation.white_columns import WhiteColumns


def fit_prior(
    model: Model, runs: Sequence[ObservedRun], question: Question, catalogue: Catalogue
) -> PriorInformation:
    """Fit what is asked about, and what the model file says was fitted, to the train runs.

    Args:
        model: what is known so far.
        runs: the train runs, with something to observe.
        question: two rivals, and parameters to be known.
        catalogue: all effects.

    Raises:
        BadInput: an effect or parameter that is unknown, or that these recordings cannot show.
    """
    effects = catalogue.on(model.vehicle)
    asked_effects = {name.partition(".")[0] for name in question.know}
    candidates = list_candidates(runs, catalogue, model.vehicle)
    for name in (*question.between, *sorted(asked_effects)):
        _check_shown(effects.find(name).id, candidates)
    start = separate(model)
    for name in question.know:
        start = _free(start, name, runs, candidates)
    if not question.between and not len(start.x):
        raise _nothing_asked(model)
    if not question.between:
        start_fit, bank = _fit(start, runs)
        names = [n for n in start.parameter_names if not question.know or n in question.know]
        rival = _summarise(start_fit, bank, names)
        return PriorInformation(tuple(runs), (), (rival,), start_fit.noise, bank.error_dynamics)
    return _fit_rivals(start, runs, question, candidates)


def _nothing_asked(model: Model) -> BadInput:
    return BadInput(
        f"nothing is asked, and {model.name} has no fitted value that could be made surer",
        where="rovsim design",
        expected="between=[a,b] or know=[effect.parameter], or a model of `rovsim add`",
        remedy="Name two effects that could not be told apart, or a value to be known better.",
    )


def _check_shown(name: str, candidates: Sequence[Candidate]) -> None:
    if any(candidate.effect.id == name for candidate in candidates):
        return
    raise BadInput(
        f"{name} cannot show in recordings like these",
        where="rovsim design",
        expected="an effect through which this vehicle acts, seen by channels that are recorded",
        remedy=f"Ask about one of {', '.join(dict.fromkeys(c.effect.id for c in candidates))}.",
    )


def check_fitted(name: str, effect: type[Effect]) -> None:
    """Refuse a parameter, `effect.parameter`, that has no standard deviation, as it is not fitted.

    Raises:
        BadInput: the effect has no such parameter, or it is tried at a few values only.
    """
    parameter = name.partition(".")[2]
    names = [p.name for p in effect.parameters if not p.discrete]
    options = (
        f"{effect.id}. and one of {', '.join(names)}" if names else "a value that can be fitted"
    )
    if parameter in names:
        return
    discrete = any(p.name == parameter for p in effect.parameters)
    raise BadInput(
        f"{parameter} is tried, not fitted" if discrete else f"unknown parameter '{parameter}'",
        where=f"know, effect {effect.id}",
        expected=options,
        remedy=f"Ask between=[{effect.id},…]." if discrete else nearest(parameter, names),
    )


def separate(model: Model) -> Hypothesis:
    """A model as a hypothesis whose free parameters are those that its file says were fitted."""
    fitted = [e for e in model.added if e.std]
    fixed = model.with_added(e for e in model.added if e not in fitted)
    return Hypothesis(fixed, tuple(Term(e, tuple(e.std)) for e in fitted))


def _free(
    h: Hypothesis, name: str, runs: Sequence[ObservedRun], candidates: Sequence[Candidate]
) -> Hypothesis:
    """Free one more parameter of a hypothesis, from the likeliest of its effect's starts."""
    effect, _, parameter = name.partition(".")
    check_fitted(name, next(c for c in candidates if c.effect.id == effect).effect)
    term = next((t for t in h.terms if t.id == effect), None)
    if term is not None:
        free = term.free if parameter in term.free else (*term.free, parameter)
        terms = tuple(replace(t, free=free) if t is term else t for t in h.terms)
        return replace(h, terms=terms)
    added = next((e for e in h.base.added if e.id == effect), None)
    if added is not None:
        return _drop_effects(h, effect).with_term(Term(added, (parameter,)))
    starts = [c.start for c in candidates if c.effect.id == effect]
    trials = [h.with_term(Term(start, (parameter,))) for start in starts]
    if len(trials) == 1:
        return trials[0]
    fits = [_fit(trial, runs)[0] for trial in trials]
    return max(fits, key=lambda trial: trial.two_log_likelihood).hypothesis


def _drop_effects(h: Hypothesis, *names: str) -> Hypothesis:
    """The hypothesis without these effects, whether they were fitted or not.

    Effects that the vehicle has by itself stay.
    """
    base = h.base.with_added(e for e in h.base.added if e.id not in names)
    return Hypothesis(base, tuple(t for t in h.terms if t.id not in names))


def _fit(h: Hypothesis, runs: Sequence[ObservedRun]) -> tuple[Fit, FilterBank]:
    bank = FilterBank.design(runs, h.model, FIRST_NOISE)
    noise, _ = bank.fit_noise(bank.innovations(h.model), FIRST_NOISE)
    best = fit(h, bank.redesign(h.model, noise), noise, PRIOR_STD)
    if not np.isfinite(best.two_log_likelihood):
        raise BadInput(
            "the train runs drive the model away from all numbers",
            where=f"model {h.base.name}",
            expected="a model that can follow the recordings",
            remedy="Diagnose the campaign first, and design with the model of `rovsim add`.",
        )
    return polish(best, runs, PRIOR_STD)


def _summarise(
    best: Fit,
    bank: FilterBank,
    wanted: Sequence[str],
    penalty: float = 0.0,
    widest: Hypothesis | None = None,
) -> FittedHypothesis:
    names = best.hypothesis.parameter_names
    chosen = np.array([names.index(name) for name in wanted], int)
    penalties = penalty * sum(term.choices for term in best.hypothesis.terms)
    two_log_likelihood, h = best.two_log_likelihood - penalties, best.hypothesis
    information = of_widest = gram(bank.flatten(best.linearised.J, best.noise))
    if widest is not None:
        linear = bank.linearise(widest)
        if linear.is_finite:  # else such a model diverges, and no more than what was fitted is free
            h, of_widest = widest, gram(bank.flatten(linear.J, best.noise))
    return FittedHypothesis(best.hypothesis, information, chosen, two_log_likelihood, h, of_widest)


def _fit_rivals(
    start: Hypothesis,
    runs: Sequence[ObservedRun],
    question: Question,
    candidates: Sequence[Candidate],
) -> PriorInformation:
    """Each rival fitted in the other's absence, beside all else."""
    rest, fits, penalty = _drop_effects(start, *question.between), [], 0.0
    for name in question.between:
        start_term = next((t for t in start.terms if t.id == name), None)
        starts = [c for c in candidates if c.effect.id == name]
        term, penalty = (start_term, penalty) if start_term else _propose(rest, runs, starts)
        fits.append(_fit(rest.with_term(term), runs))
    penalty = max(penalty, 2.0 * float(np.log(len(candidates))))
    rivals = []
    for name, (answer, bank) in zip(question.between, fits, strict=True):
        names = answer.hypothesis.parameter_names
        chosen = [n for n in names if n in question.know or n.startswith(f"{name}.")]
        rivals.append(_summarise(answer, bank, chosen, penalty, widen(answer.hypothesis, name)))
    best, bank = max(fits, key=lambda pair: pair[0].two_log_likelihood)
    rival_names = tuple(question.between)
    return PriorInformation(
        tuple(runs), rival_names, tuple(rivals), best.noise, bank.error_dynamics
    )


def widen(h: Hypothesis, effect: str) -> Hypothesis:
    """Free all parameters of one effect that have an influence at its present values."""

    def widened(term: Term) -> Term:
        names = term.effect.free_at(term.effect.given())
        return replace(term, free=tuple(dict.fromkeys((*term.free, *names))))

    return replace(h, terms=tuple(widened(t) if t.id == effect else t for t in h.terms))


def _propose(
    h: Hypothesis, runs: Sequence[ObservedRun], own: Sequence[Candidate]
) -> tuple[Term, float]:
    """The start and free parameters of an effect that promise most, and the penalty of each."""
    rest_fit, bank = _fit(h, runs)
    linearised = linearise_candidates(bank, rest_fit.hypothesis, own)
    first_order = FirstOrder(WhiteColumns(bank, linearised, rest_fit.noise))
    return first_order.propose(rest_fit)[0].term, first_order.penalty
