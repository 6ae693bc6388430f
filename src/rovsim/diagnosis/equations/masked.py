"""A law that names of the catalogue stand in for.

What names leave of a law that they resemble is taken for a disturbance, and beside one of that size
it does not stand out: a drag u^2 v that was called lift and linear damping was 20 in twice the log
likelihood under the noise that they leave, and 900 with a noise of its own. So what nearly stands
out is fitted as a law, with the noise and all else.
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

# Likelihood-ratio statistics. Of all functions of an axis one reaches 15 by chance in one campaign
# of fifteen, 8 in most; of those that names could have taken half of there are few.
SUSPECT, RESEMBLES, FAINT = 15.0, 0.5, 8.0
TRIED = 3  # laws that are fitted


def find_masked_laws(selection: SearchResult) -> list[Structure]:
    """The law that stands out once it has a noise of its own; none where there is no name."""
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
    kinds = choose_kinds([columns.terms[k] for k in order])[:TRIED]
    score = workspace.score(fit)
    for judged in fit_products(fits, fit, (), kinds, columns).values():
        if fits.is_worth(judged, fit, score):
            return [replace(suspect, times_limit=(judged.score - score) / max(fits.chance, 1.0))]
    return []


def _find_suspect(selection: SearchResult) -> Structure | None:
    """What comes nearest to standing out, of what names could have taken most of, or of all."""
    bank = selection.workspace.bank
    tables = [tabulate(run) for run in bank.runs]
    near = [
        Structure(
            residual.axis,
            one.name,
            min(1.0, (one.size / residual.disturbance_std) ** 2),
            one.statistic,
        )
        for residual in split_by_axis(selection.best, bank)
        for one in list_dependences(residual, tables)
        if one.statistic > (FAINT if one.taken > RESEMBLES else SUSPECT)
    ]
    return max(near, key=lambda one: one.times_limit, default=None)
