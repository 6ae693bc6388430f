"""Predict how candidate terms of a law would appear in the whitened innovations of a fit.

A force that the model lacks appears in the innovations in proportion to its coefficient. For a
coefficient of 1, that response is the column of a term. The search for terms regresses the
innovations on these columns.
"""

from dataclasses import dataclass
from typing import Any, Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.structure.response import respond
from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.least_squares import find_decreases
from rovsim.estimation.observer.noise import RunFilters
from rovsim.estimation.observer.observed_run import ObservedRun, number_blocks

FOLDS = 3  # groups of time blocks, each of which is left out once by the regression
MIN_ACCELERATION = 1e-9  # m/s2 or rad/s2: acceleration of an axis by a wrench with an RMS of 1 N

# Evaluates terms with a coefficient of 1 along a run, as `library.evaluate_wrenches`: (c, n, 6).
Wrenches = Callable[[Sequence[Any], ObservedRun, Model, Array], Array]


@dataclass(frozen=True, eq=False)
class Columns:
    """The Gram matrix of c terms' columns and the whitened innovations, summed over all axes.

    Its row and column 0 are the innovations, and the others the columns of the terms, each for a
    wrench with an RMS of 1 N (or N m). The directions of the fitted parameters are projected out.

    Attributes:
        terms: the c terms that act at all.
        size: RMS (c,) of the wrench of each term with a coefficient of 1.
        parts: Gram matrix (1 + c, 1 + c) of each group of time blocks.
        middle: (4,) place in NED and width, m, of terms that have none of their own.
    """

    terms: tuple[Any, ...]
    size: Array
    parts: tuple[Array, ...]
    middle: Array

    @property
    def gram(self) -> Array:
        """Gram matrix (1 + c, 1 + c) of all readings."""
        return np.asarray(sum(self.parts))

    @property
    def decreases(self) -> Array:
        """Decrease (c,) of the sum of squared innovations by each term as the only addition."""
        G = self.gram
        return find_decreases(G[1:, 1:], G[1:, 0])


def project(
    terms: Sequence[Any], fit: Fit, bank: FilterBank, middle: Array, wrenches: Wrenches
) -> Columns:
    """Compute the columns of candidate terms on top of a fit, and their Gram matrix.

    Args:
        terms: the candidates.
        fit: gives the innovations, and the directions of its parameters, which are projected out.
        bank: the runs that it was fitted to, with their filters.
        middle: (4,) place in NED and width, m, of terms that have none of their own.
        wrenches: evaluates terms with a coefficient of 1.

    Returns:
        The columns, without terms whose wrench is zero throughout.
    """
    model, noise = fit.hypothesis.model, fit.noise
    white, derivatives = bank.whiten(fit.linearised.e, noise), bank.whiten(fit.linearised.J, noise)
    block = number_blocks(bank.runs) % FOLDS
    size = _measure_size(terms, model, bank.runs, middle, wrenches)
    acts = np.flatnonzero(size > 0.0)
    acting_terms = tuple(terms[int(k)] for k in acts)
    rows = 1 + len(acts) + len(derivatives)
    parts = {int(k): np.zeros((rows, rows)) for k in np.unique(block)}
    begin = 0
    for run, filters in zip(bank.runs, bank.design_filters(noise), strict=True):
        # the columns of one run at a time
        unit_wrenches = wrenches(acting_terms, run, model, middle) / size[acts, None, None]
        columns = _respond(unit_wrenches, model, run, filters)
        at = slice(begin, begin + columns.shape[2])
        pieces = [white[:, None, at], columns, derivatives[:, :, at].swapaxes(0, 1)]
        stacked = np.concatenate(pieces, axis=1, dtype=np.float32)
        for k in np.unique(block[at]):
            in_block = stacked[:, :, block[at] == k]
            parts[int(k)] += sum(axis @ axis.T for axis in in_block)
        begin = at.stop
    own_parts = _project_out(list(parts.values()), 1 + len(acts))
    return Columns(acting_terms, size[acts], tuple(own_parts), middle)


def _respond(wrenches: Array, model: Model, run: ObservedRun, filters: RunFilters) -> Array:
    """Filter wrenches as the innovations of a run would show them.

    Args:
        wrenches: (c, n, 6) along the body axes at all readings, N and N m.
        model: gives the inertia.
        run: the run.
        filters: of each axis of that run.

    Returns:
        The response (6, c, m) in the whitened innovations of the m settled readings; zero on axes
        that were not measured, or in which the vehicle cannot move.
    """
    accelerations = wrenches @ model.body.M_inv.T
    out = np.zeros((6, len(wrenches), int(run.settled.sum())), np.float32)
    for i in np.flatnonzero(run.axes):
        acceleration = accelerations[:, :, i]
        acts = np.flatnonzero(np.abs(acceleration).max(axis=1) > MIN_ACCELERATION)
        if len(acts):
            out[i, acts] = respond(acceleration[acts], filters.filters[i], run)
    return out


def _measure_size(
    terms: Sequence[Any],
    model: Model,
    runs: Sequence[ObservedRun],
    middle: Array,
    wrenches: Wrenches,
) -> Array:
    """RMS (c,) over all runs of the wrench of each term with a coefficient of 1, of all axes."""
    square, count = np.zeros(len(terms)), 0
    for run in runs:
        wrench = wrenches(terms, run, model, middle)
        square, count = square + np.sum(wrench**2, axis=(1, 2)), count + wrench.shape[1]
    return np.asarray(np.sqrt(square / count))


def _project_out(parts: Sequence[Array], kept: int) -> list[Array]:
    """Project directions out of Gram matrices: the Schur complement, as for the sum of all parts.

    Args:
        parts: Gram matrix of each group of time blocks.
        kept: how many rows and columns stay; those after them are projected out.

    Returns:
        A matrix (kept, kept) for each part.
    """
    G = np.asarray(sum(parts))
    if len(G) == kept:
        return list(parts)
    H = G[kept:, kept:]
    scale = np.sqrt(np.maximum(np.diag(H), 1e-300))
    coefficients = -np.linalg.lstsq(
        H / np.outer(scale, scale), G[kept:, :kept] / scale[:, None], 1e-9
    )[0]
    T = np.vstack([np.eye(kept), coefficients / scale[:, None]])
    return [T.T @ part @ T for part in parts]
