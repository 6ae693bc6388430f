"""Find accepted effects whose values vary from run to run more than noise lets them.

What belongs to a vehicle, or to its log, is the same in all runs. Something else that acts in one
of them alone may be called by an effect's name there, and the mean over the runs looks sure. A
pilot whose sensors see more than the cameras is such a case: thrust then tells how the vehicle
moves before the cameras do, which the filters do not know, and a heading that an inertial sensor
held was a dry friction of probability 1.

Rao's score test (Rao 1948, Proc. Camb. Phil. Soc. 44, 50): each run gets values of its own, beside
common values of all other effects, and to first order these explain so much more. That has to be a
fair part of what the effect itself explains: a lag of 98 ms in one run and of 100 in another is a
lag.
"""

from typing import Sequence

import numpy as np
from scipy.linalg import block_diag
from scipy.stats import chi2

from rovsim.diagnosis.checks.by_run import ProductsByRun
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.least_squares import solve

MIN_VARYING_SHARE = 0.25  # of Wald's statistic of the effect: what varies is half of it in size
MIN_EIGENVALUE = 1e-6  # of unit directions: in a smaller one, the runs do not tell values apart


def find_varying(fit: Fit, bank: FilterBank) -> set[str]:
    """Ids of the effects of a fit that would have another value in each run.

    Args:
        fit: to all runs, at its likeliest values.
        bank: that it was fitted with.
    """
    if not fit.is_finite or not len(fit.hypothesis.x):
        return set()
    e, J = (bank.whiten(x, fit.noise) for x in (fit.linearised.e, fit.linearised.J))
    products = ProductsByRun.of(e, J, bank.runs)
    h, varying = fit.hypothesis, set()
    for term, own in zip(h.terms, h.columns, strict=True):
        statistic, freedom = score_difference(products, own)
        sure = freedom and chi2.sf(statistic, freedom) < FALSE_ALARM_RATE / len(h.terms)
        if sure and statistic > MIN_VARYING_SHARE * fit.wald_statistic(own):
            varying.add(term.id)
    return varying


def score_difference(products: ProductsByRun, own: Sequence[int]) -> tuple[float, int]:
    """Rao's statistic against common values of some parameters, and its degrees of freedom.

    Args:
        products: of all parameters.
        own: numbers of those that may have other values in each run.
    """
    total, common = products.gram.sum(axis=0), products.b.sum(axis=0)
    across = np.concatenate([G[own] for G in products.gram])
    H = block_diag(*products.only(own).gram) - across @ solve(total, across.T)
    b = products.only(own).b.ravel() - across @ solve(total, common)
    # a step of all runs alike is one of the common values: that direction is empty
    scale = np.sqrt(np.maximum(np.concatenate([np.diag(G)[own] for G in products.gram]), 1e-300))
    size, directions = np.linalg.eigh(H / np.outer(scale, scale))
    known = size > MIN_EIGENVALUE
    along = (directions.T @ (b / scale))[known]
    return float(np.sum(along**2 / size[known])), int(known.sum())
