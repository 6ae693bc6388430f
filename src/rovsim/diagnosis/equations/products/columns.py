"""How candidate terms of an equation would show in what the model did not foresee."""

from dataclasses import dataclass
from typing import Any, Callable, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter

from rovsim.dynamics.model import Model
from rovsim.estimation.fit import Fit
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.noise import RunFilters
from rovsim.estimation.observer.observed_run import ObservedRun, number_blocks

BLOCKS = 3  # parts of the runs, each of which is left out once by the regression
NEGLIGIBLE = 1e-9  # of an axis' acceleration per newton

Wrenches = Callable[[Sequence[Any], ObservedRun, Model, Array], Array]  # as `library.push`


@dataclass(frozen=True, eq=False)
class Columns:
    """Terms, the size (c,) of each per unit coefficient, and the Gram matrix of what they do.

    `gram` (1 + c, 1 + c) of whitened innovations and the terms' columns, each of unit size;
    what was fitted is projected out. One for all readings, and one `parts` for each block of time.
    `middle` (4,): place NED m and width m of terms that have none of their own.
    """

    terms: tuple[Any, ...]
    size: Array
    parts: tuple[Array, ...]
    middle: Array

    @property
    def gram(self) -> Array:
        """Over all blocks."""
        return np.asarray(sum(self.parts))


def project(
    terms: Sequence[Any], fit: Fit, bank: FilterBank, middle: Array, wrenches: Wrenches
) -> Columns:
    """Gram matrix of all terms' columns and what a fit leaves, less what it takes up itself.

    Args:
        terms: the candidates, on top of the fit.
        fit: whose derivatives' directions are left out.
        bank: the runs.
        middle: see `Columns`.
        wrenches: of terms, with a coefficient of 1.
    """
    model, noise = fit.hypothesis.model, fit.noise
    white, fitted = bank.whiten(fit.linearised.e, noise), bank.whiten(fit.linearised.J, noise)
    block = number_blocks(bank.runs) % BLOCKS
    size = _measure_size(terms, model, bank.runs, middle, wrenches)
    acts = np.flatnonzero(size > 0.0)
    kept = tuple(terms[int(k)] for k in acts)
    rows = 1 + len(acts) + len(fitted)
    parts = {int(k): np.zeros((rows, rows)) for k in np.unique(block)}
    first = 0
    for run, filters in zip(bank.runs, bank.design_filters(noise), strict=True):
        # columns of one run at a time
        pushes = wrenches(kept, run, model, middle) / size[acts, None, None]
        columns = _respond(pushes, model, run, filters)
        at = slice(first, first + columns.shape[2])
        every = [white[:, None, at], columns, fitted[:, :, at].swapaxes(0, 1)]
        whole = np.concatenate(every, axis=1, dtype=np.float32)
        for k in np.unique(block[at]):
            own = whole[:, :, block[at] == k]
            parts[int(k)] += sum(axis @ axis.T for axis in own)
        first = at.stop
    own_parts = _without(list(parts.values()), 1 + len(acts))
    return Columns(kept, size[acts], tuple(own_parts), middle)


def _respond(pushes: Array, model: Model, run: ObservedRun, filters: RunFilters) -> Array:
    """How wrenches (c, n, 6) would show in whitened settled innovations (6, c, m) of a run."""
    accelerations = pushes @ model.body.M_inv.T
    out = np.zeros((6, len(pushes), int(run.settled.sum())), np.float32)
    whole = np.empty(pushes.shape[:2])
    for i in np.flatnonzero(run.axes):
        own = accelerations[:, :, i]
        acts = np.flatnonzero(np.abs(own).max(axis=1) > NEGLIGIBLE)
        if not len(acts):
            continue
        b, a = filters.filters[i].response
        for first, last in run.innovation_segments:
            whole[acts, first:last] = lfilter(b, a, own[acts, first:last], axis=1)
        out[i, acts] = whole[acts][:, run.settled]
    return out


def _measure_size(
    terms: Sequence[Any],
    model: Model,
    runs: Sequence[ObservedRun],
    middle: Array,
    wrenches: Wrenches,
) -> Array:
    """Root mean square (c,) of the wrench of each term with a coefficient of 1, over all runs."""
    square, count = np.zeros(len(terms)), 0
    for run in runs:
        own = wrenches(terms, run, model, middle)
        square, count = square + np.sum(own**2, axis=(1, 2)), count + own.shape[1]
    return np.asarray(np.sqrt(square / count))


def _without(parts: Sequence[Array], kept: int) -> list[Array]:
    """Gram matrix (kept, kept) of each part: the directions behind taken out as in the whole."""
    whole = np.asarray(sum(parts))
    if len(whole) == kept:
        return list(parts)
    H = whole[kept:, kept:]
    scale = np.sqrt(np.maximum(np.diag(H), 1e-300))
    along = -np.linalg.lstsq(
        H / np.outer(scale, scale), whole[kept:, :kept] / scale[:, None], 1e-9
    )[0]
    T = np.vstack([np.eye(kept), along / scale[:, None]])
    return [T.T @ part @ T for part in parts]
