"""What is learned and predicted: features and residual accelerations of the default campaign."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.learned.layout import FADING_RANK
from rovsim.dynamics.learned.residual import Residual
from rovsim.dynamics.learned.settings import FeatureSettings
from rovsim.learning.export import Kernel, export_expansion, export_neighbours
from rovsim.learning.learner import learner_settings, train
from rovsim.learning.scaling import fit_scaling

DRAW_SEED = 5  # of the rows that are drawn
NEIGHBOUR_COUNT = 5


@dataclass(frozen=True, eq=False)
class Pairs:
    """Features and residual accelerations of train runs, and queries of test runs.

    Attributes:
        X: features (n, 12) of the train rows.
        Y: residual accelerations (n, 6), m/s2 and rad/s2.
        control: kind of run (n,) of each train row, such as `3dof`.
        queries: features (q, 12) of the test rows.
        answers: true residual accelerations (q, 6) at the queries.
        query_control: kind of run (q,) of each query.
    """

    X: Array
    Y: Array
    control: Array
    queries: Array
    answers: Array
    query_control: Array

    def drawn(self) -> "Pairs":
        """Shuffle the train rows."""
        order = np.random.default_rng(DRAW_SEED).permutation(len(self.X))
        return replace(self, X=self.X[order], Y=self.Y[order], control=self.control[order])

    def first(self, rows: int) -> "Pairs":
        """Keep the first train rows."""
        return replace(self, X=self.X[:rows], Y=self.Y[:rows], control=self.control[:rows])

    def of(self, control: str) -> "Pairs":
        """Keep the train rows of one kind of run."""
        rows = self.control == control
        return replace(self, X=self.X[rows], Y=self.Y[rows], control=self.control[rows])

    def exported(self, kind: str, rows: int, outputs: int) -> Array:
        """Export a predictor of the first outputs only, for timing: hyperparameters are not fitted.

        Args:
            kind: `knn`, or a Gaussian process.
            rows: number of train rows.
            outputs: number of outputs, 1 to 6.

        Returns:
            The predictor, packed for the compiled loop.
        """
        X, Y, features = self.X[:rows], self.Y[:rows, :outputs], FeatureSettings()
        scaling = fit_scaling("standard", X)
        Z = scaling.apply(X)
        if kind == "knn":
            return export_neighbours(features, scaling, Z, Y, NEIGHBOUR_COUNT, "distance")
        kernel = Kernel(Z, np.full(Z.shape[1], 5.0), Y)
        return export_expansion(features, scaling, np.zeros(outputs), [kernel])


def fitted(kind: str, pairs: Pairs, **more: Any) -> Residual:
    """Train a residual of a kind, with these settings of its learner."""
    settings = {"k": NEIGHBOUR_COUNT, **more} if kind == "knn" else more
    learner = learner_settings({"kind": kind, **settings})
    return train(pairs.X, pairs.Y, learner, seed=0, control="6dof")


def unfading(residual: Residual) -> Residual:
    """Return the same residual as `extrapolation_quantile=null` would train it: without fading."""
    data = residual.data.copy()
    data[FADING_RANK] = 0.0
    return replace(residual, data=data)
