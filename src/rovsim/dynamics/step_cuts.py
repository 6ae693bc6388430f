"""Steps cut where a line of a log takes effect, and means over them of what the log says."""

from typing import NamedTuple

import numpy as np
import scipy.sparse
from numpy import ndarray as Array

from rovsim.core.run import latest

KEPT = 4  # of a run: the commands as they come, a little later, and with another clock


class StepCut(NamedTuple):
    """Pieces of steps within which no line takes effect.

    `middle` (p,) s of each; `mean` (k, m) averages over each step what m lines, or pieces, say.
    """

    middle: Array
    mean: scipy.sparse.csr_array

    @staticmethod
    def at(arrival: Array, edges: Array, by_line: bool) -> "StepCut":
        """The steps between `edges` (k+1,) s, cut where lines (m,) arrive.

        `by_line`: what is averaged is known of each line, which holds until the next; else of each
        piece.
        """
        pieces = np.union1d(edges, arrival[(arrival > edges[0]) & (arrival < edges[-1])])
        middle = 0.5 * (pieces[1:] + pieces[:-1])
        source = latest(arrival, middle) if by_line else np.arange(len(middle))
        bounds = np.searchsorted(pieces, edges)
        share = np.diff(pieces) / np.repeat(np.diff(edges), np.diff(bounds))
        shape = len(edges) - 1, int(source.max(initial=-1)) + 1
        return StepCut(middle, scipy.sparse.csr_array((share, source, bounds), shape))

    def average(self, x: Array) -> Array:
        """Means (k, c) over the steps of what lines or pieces say (m, c)."""
        return np.asarray(self.mean @ x[: self.mean.shape[1]])


class StepCuts:
    """The cuts that were asked for last.

    Most models let a command take effect when others do, and to cut takes longer than to average.
    """

    def __init__(self) -> None:
        self._kept: tuple[tuple[Array, Array, bool, StepCut], ...] = ()

    def at(self, arrival: Array, edges: Array, by_line: bool) -> StepCut:
        """As `StepCut.at`."""
        for known in self._kept:
            if known[2] is by_line and _alike(known[0], arrival) and _alike(known[1], edges):
                return known[3]
        cut = StepCut.at(arrival, edges, by_line)
        self._kept = ((arrival, edges, by_line, cut), *self._kept[: KEPT - 1])
        return cut


def _alike(a: Array, b: Array) -> bool:
    return a is b or np.array_equal(a, b)
