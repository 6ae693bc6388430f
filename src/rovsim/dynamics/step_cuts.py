"""Divide integration steps where logged lines take effect, and average logged values over them."""

from typing import NamedTuple

import numpy as np
import scipy.sparse
from numpy import ndarray as Array

from rovsim.core.run import latest

MAX_KEPT_CUTS = 4  # cuts of a run: for commands as logged, a little later, and on another clock


class StepCut(NamedTuple):
    """Steps divided into pieces within which no logged line takes effect.

    Attributes:
        middle: (p,) middle of each of p pieces, s.
        mean: sparse (k, m) matrix of the averages over k steps, from values of m lines or pieces.
    """

    middle: Array
    mean: scipy.sparse.csr_array

    @staticmethod
    def at(arrival: Array, edges: Array, by_line: bool) -> "StepCut":
        """Divide steps at the instants at which lines take effect.

        Args:
            arrival: (m,) instants at which the lines take effect, s.
            edges: (k+1,) instants between the steps, s.
            by_line: whether the values to average belong to lines, each of which holds until the
                next one; otherwise they belong to pieces.
        """
        pieces = np.union1d(edges, arrival[(arrival > edges[0]) & (arrival < edges[-1])])
        middle = 0.5 * (pieces[1:] + pieces[:-1])
        source = latest(arrival, middle) if by_line else np.arange(len(middle))
        bounds = np.searchsorted(pieces, edges)
        share = np.diff(pieces) / np.repeat(np.diff(edges), np.diff(bounds))
        shape = len(edges) - 1, int(source.max(initial=-1)) + 1
        return StepCut(middle, scipy.sparse.csr_array((share, source, bounds), shape))

    def average(self, x: Array) -> Array:
        """Means (k, c) over each step of values (m, c) of lines or pieces."""
        return np.asarray(self.mean @ x[: self.mean.shape[1]])


class StepCuts:
    """A cache of the last few cuts of a run.

    In most models commands take effect at the same instants, and cutting takes longer than
    averaging.
    """

    def __init__(self) -> None:
        self._kept: tuple[tuple[Array, Array, bool, StepCut], ...] = ()

    def at(self, arrival: Array, edges: Array, by_line: bool) -> StepCut:
        """Return `StepCut.at` of the same arguments, from the cache if possible."""
        for entry in self._kept:
            if entry[2] is by_line and _alike(entry[0], arrival) and _alike(entry[1], edges):
                return entry[3]
        cut = StepCut.at(arrival, edges, by_line)
        self._kept = ((arrival, edges, by_line, cut), *self._kept[: MAX_KEPT_CUTS - 1])
        return cut


def _alike(a: Array, b: Array) -> bool:
    return a is b or np.array_equal(a, b)
