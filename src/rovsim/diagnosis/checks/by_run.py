"""Products of derivatives and innovations, run by run: do all runs ask for the same values?"""

from collections import defaultdict
from typing import NamedTuple, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.diagnosis.structure.residual import split_by_run
from rovsim.estimation.observer.least_squares import as_rows, solve
from rovsim.estimation.observer.observed_run import ObservedRun


class ProductsByRun(NamedTuple):
    """Products, for each of R runs, of k derivatives with each other and with the innovations.

    Attributes:
        gram: (R, k, k).
        b: (R, k).
    """

    gram: Array
    b: Array

    @staticmethod
    def of(e: Array, derivatives: Array, parts: Sequence[ObservedRun]) -> "ProductsByRun":
        """Multiply derivatives (k, 6, n) with each other and with innovations (6, n), both white.

        Args:
            e: innovations of all parts of runs, one after the other.
            derivatives: of the innovations.
            parts: of the runs; of long ones there may be several.
        """
        e_parts, J_parts = split_by_run(e, parts), split_by_run(derivatives, parts)
        rows, groups = [as_rows(part) for part in J_parts], group_runs(parts).values()
        gram = [sum(rows[k] @ rows[k].T for k in own) for own in groups]
        b = [sum(rows[k] @ e_parts[k].ravel() for k in own) for own in groups]
        return ProductsByRun(np.array(gram, float), np.array(b, float))

    def only(self, kept: Sequence[int]) -> "ProductsByRun":
        """The products of some of the derivatives alone."""
        return ProductsByRun(self.gram[:, kept][:, :, kept], self.b[:, kept])

    @property
    def steps(self) -> Array:
        """Steps (R, k) of the parameters that explain each run best."""
        return -np.stack([solve(G, b) for G, b in zip(self.gram, self.b, strict=True)])

    @property
    def difference(self) -> float:
        """By how much steps of each run lower the sum of squares more than common steps do."""
        common = self.b.sum(axis=0)
        apart = -float(np.sum(self.steps * self.b))
        return apart - float(common @ solve(self.gram.sum(axis=0), common))


def group_runs(parts: Sequence[ObservedRun]) -> dict[str, list[int]]:
    """Places of the parts of each run, by the run's id."""
    places = defaultdict(list)
    for k, run in enumerate(parts):
        places[run.motion.run.id].append(k)
    return dict(places)
