"""Find a law that accepted effects of the catalogue stand in for.

Effects that resemble a law explain part of it. The noise fit takes the rest for a disturbance, and
beside a disturbance of that size the rest does not stand out. For example, a drag u^2 v was
mistaken for lift and linear damping: the gain in twice the log likelihood was 20 under the noise
fitted beside these effects, and 900 when the noise was fitted again beside the law. So what nearly
stands out is fitted as a law, together with the noise and the accepted effects.
"""

from dataclasses import replace

import numpy as np

from rovsim.diagnosis.equations.law_fits import LawFits
from rovsim.diagnosis.equations.law_search import is_seen
from rovsim.diagnosis.equations.products.library import list_terms, middle_of
from rovsim.diagnosis.equations.products.search import find_alone
from rovsim.diagnosis.equations.products.selection import choose_kinds, fit_products
from rovsim.diagnosis.selection.search_result import SearchResult
from rovsim.diagnosis.structure.regressors import list_dependences, tabulate
from rovsim.diagnosis.structure.residual import Structure, split_by_axis

# A function is suspect if its likelihood-ratio statistic exceeds MIN_LR_OF_MASKED, or
# MIN_LR_OF_SIMILAR if the fitted parameters could have explained more than MIN_EXPLAINABLE_SHARE of
# its power. By chance, the best of all functions of an axis reaches 15 in one campaign of fifteen
# and 8 in most, but only few functions are so similar to accepted effects.
MIN_LR_OF_MASKED, MIN_EXPLAINABLE_SHARE, MIN_LR_OF_SIMILAR = 15.0, 0.5, 8.0
LAWS_TRIED = 3  # fitted


def find_masked_laws(selection: SearchResult) -> list[Structure]:
    """Find structure that stands out only once a law is fitted together with the noise.

    Returns:
        The suspect structure, with its `times_limit` taken from the fitted law, where such a law is
        worth its penalty. Otherwise nothing, as where no effect of the catalogue was accepted or
        some axis is not read at every reading.
    """
    names = [term for term in selection.best.hypothesis.terms if term.effect.listed]
    suspect = _find_suspect(selection) if names and is_seen(selection) else None
    if suspect is None:
        return []
    workspace, fit = selection.workspace, selection.best
    runs = workspace.bank.runs
    terms = list_terms(runs)
    fits = LawFits(selection, len(terms))
    columns = fits.project(fit, terms, middle_of(runs))
    order = np.argsort(-find_alone(columns.gram), kind="stable")
    kinds = choose_kinds([columns.terms[k] for k in order])[:LAWS_TRIED]
    score = workspace.score(fit)
    for law in fit_products(fits, fit, (), kinds, columns).values():
        if fits.is_worth(law, fit, score):
            return [replace(suspect, times_limit=(law.score - score) / max(fits.chance, 1.0))]
    return []


def _find_suspect(selection: SearchResult) -> Structure | None:
    """Find the most suspect function that innovations seem to follow; None where none is suspect.

    The `times_limit` of the structure is here the test statistic itself.
    """
    bank = selection.workspace.bank
    tables = [tabulate(run) for run in bank.runs]
    structures = [
        Structure(
            residual.axis,
            dependence.name,
            min(1.0, (dependence.size / residual.disturbance_std) ** 2),
            dependence.statistic,
        )
        for residual in split_by_axis(selection.best, bank)
        for dependence in list_dependences(residual, tables)
        if dependence.statistic
        > (MIN_LR_OF_SIMILAR if dependence.taken > MIN_EXPLAINABLE_SHARE else MIN_LR_OF_MASKED)
    ]
    return max(structures, key=lambda dependence: dependence.times_limit, default=None)
