"""Find a law that accepted effects of the catalogue stand in for.

Effects that resemble a law explain part of it. The noise fit takes the rest for a disturbance, and
beside a disturbance of that size the rest does not stand out. For example, a drag u^2 v was
mistaken for lift and linear damping: the gain in twice the log likelihood was 20 under the noise
fitted beside these effects, and 900 when the noise was fitted again beside the law. So what nearly
stands out is fitted as a law, together with the noise and the accepted effects.

Play of the thrusters, or a limit on how fast they change, leaves nothing that could stand out: a
lag, a curve of the thrust and a delay shape the thrust in time as well, and with enough of them the
rest passes for noise (eight names, five of them at a probability of one). So laws of how thrusters
answer are fitted wherever several effects shape the thrust.
"""

from dataclasses import replace
from typing import Sequence

import numpy as np

from rovsim.core.axes import AXES
from rovsim.diagnosis.equations.action import find_action
from rovsim.diagnosis.equations.law_fits import LawFits
from rovsim.diagnosis.equations.law_search import fit_memory_laws, is_seen
from rovsim.diagnosis.equations.products.library import LawTerm, list_terms, middle_of
from rovsim.diagnosis.equations.products.selection import choose_kinds, fit_products
from rovsim.diagnosis.equations.with_memory import OF_THRUSTERS
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.structure.regressors import list_dependences, tabulate
from rovsim.diagnosis.structure.residual import Structure, split_by_axis
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank

# A function is suspect if its likelihood-ratio statistic exceeds MIN_LR_OF_MASKED, or
# MIN_LR_OF_SIMILAR if the fitted parameters could have explained more than MIN_EXPLAINABLE_SHARE of
# its power. By chance, the best of all functions of an axis reaches 15 in one campaign of fifteen
# and 8 in most, but only few functions are so similar to accepted effects.
MIN_LR_OF_MASKED, MIN_EXPLAINABLE_SHARE, MIN_LR_OF_SIMILAR = 15.0, 0.5, 8.0
LAWS_TRIED = 3  # fitted
SHAPES_THRUST = ("thrusters", "commands")  # what an effect requires that shapes thrust in time
MIN_IMITATORS = 2  # effects that shape the thrust: one alone does not imitate such a law


def find_masked_laws(selection: SearchResult, least_gain: float) -> list[Structure]:
    """Find structure that stands out only once a law is fitted together with the noise.

    Args:
        selection: where the search ended.
        least_gain: in twice the log likelihood, that a law has to exceed: what a fit of the whole
            vehicle file gains, where the file is loose, for what it leaves looks like a law.

    Returns:
        The structure, with its `times_limit` taken from the fitted law, where such a law is worth
        its penalty. Otherwise nothing, as where no effect of the catalogue was accepted or some
        axis is not read at every reading.
    """
    effects = [term.effect for term in selection.best.hypothesis.terms if term.effect.listed]
    if not effects or not is_seen(selection):
        return []
    terms = list_terms(selection.workspace.bank.runs)
    fits = LawFits(selection, len(terms))
    shaping = sum(effect.requires in SHAPES_THRUST for effect in effects)
    answering = _find_masked_answer(fits, least_gain) if shaping >= MIN_IMITATORS else []
    return answering or _find_masked_products(fits, terms, least_gain)


def _find_masked_answer(fits: LawFits, least_gain: float) -> list[Structure]:
    """A law of how thrusters answer as a structure, where it is worth its penalty beside effects.

    Its share is that of the disturbance which is not needed beside it.
    """
    fit = fits.selection.best
    laws = filter(None, fit_memory_laws(fits, fit.hypothesis, OF_THRUSTERS))
    law = max(laws, key=lambda law: law.score, default=None)
    if law is None:
        return []
    gain = law.score - fits.workspace.score(fit)
    if gain <= max(least_gain, fits.chance):  # it may stand in the place of a lag
        return []
    axis = find_action(law.form, law.fit, fits.runs).axis
    without, beside = (f.noise.disturbance_std[AXES.index(axis)] for f in (fit, law.fit))
    share = max(0.0, 1.0 - float(beside / without) ** 2)
    return [Structure(axis, "thrust with a memory", share, gain / max(fits.chance, 1.0))]


def _find_masked_products(
    fits: LawFits, terms: Sequence[LawTerm], least_gain: float
) -> list[Structure]:
    """The suspect function as a structure, where a product of states is worth its penalty."""
    fit = fits.selection.best
    suspect = _find_suspect(fit, fits.workspace.bank)
    if suspect is None:
        return []
    columns = fits.project(fit, terms, middle_of(fits.runs))
    order = np.argsort(-columns.decreases, kind="stable")
    kinds = choose_kinds([columns.terms[k] for k in order])[:LAWS_TRIED]
    score = fits.workspace.score(fit)
    for law in fit_products(fits, fit, (), kinds, columns).values():
        if law.score - score > least_gain and fits.is_worth(law, fit, score):
            return [replace(suspect, times_limit=(law.score - score) / max(fits.chance, 1.0))]
    return []


def _find_suspect(fit: Fit, bank: FilterBank) -> Structure | None:
    """Find the most suspect function that innovations seem to follow; None where none is suspect.

    The `times_limit` of the structure is here the test statistic itself.
    """
    tables = [tabulate(run) for run in bank.runs]
    structures = [
        Structure(
            residual.axis,
            dependence.name,
            min(1.0, (dependence.size / residual.disturbance_std) ** 2),
            dependence.statistic,
        )
        for residual in split_by_axis(fit, bank)
        for dependence in list_dependences(residual, tables)
        if dependence.statistic
        > (MIN_LR_OF_SIMILAR if dependence.taken > MIN_EXPLAINABLE_SHARE else MIN_LR_OF_MASKED)
    ]
    return max(structures, key=lambda dependence: dependence.times_limit, default=None)
