"""What is learnt and asked in the benchmark: residual features of the default campaign."""

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

SEED = 5  # of the rows that are drawn
NEIGHBOURS = 5


@dataclass(frozen=True, eq=False)
class Pairs:
    """Features X (n, 12) and residual accelerations Y (n, 6) of train runs, queries of test runs.

    `control` (n,) and `query_control` (q,) say which rows are of which kind of run; `answers`
    (q, 6) what was true at the queries.
    """

    X: Array
    Y: Array
    control: Array
    queries: Array
    answers: Array
    query_control: Array

    def drawn(self) -> "Pairs":
        """The train rows in a drawn order."""
        order = np.random.default_rng(SEED).permutation(len(self.X))
        return replace(self, X=self.X[order], Y=self.Y[order], control=self.control[order])

    def first(self, rows: int) -> "Pairs":
        """The first train rows."""
        return replace(self, X=self.X[:rows], Y=self.Y[:rows], control=self.control[:rows])

    def of(self, control: str) -> "Pairs":
        """The train rows of one kind of run."""
        rows = self.control == control
        return replace(self, X=self.X[rows], Y=self.Y[rows], control=self.control[rows])

    def exported(self, kind: str, rows: int, outputs: int) -> Array:
        """A predictor for only the first so many outputs; a process with some hyperparameters."""
        X, Y, features = self.X[:rows], self.Y[:rows, :outputs], FeatureSettings()
        scaling = fit_scaling("standard", X)
        Z = scaling.apply(X)
        if kind == "knn":
            return export_neighbours(features, scaling, Z, Y, NEIGHBOURS, "distance")
        kernel = Kernel(Z, np.full(Z.shape[1], 5.0), Y)
        return export_expansion(features, scaling, np.zeros(outputs), [kernel])


def fitted(kind: str, pairs: Pairs, **more: Any) -> Residual:
    """A residual of that kind."""
    settings = {"k": NEIGHBOURS, **more} if kind == "knn" else more
    trained = train(pairs.X, pairs.Y, learner_settings({"kind": kind, **settings}), seed=0)
    return trained.residual("6dof")


def unfading(residual: Residual) -> Residual:
    """The same residual, as `extrapolation_quantile=null` would train it."""
    data = residual.data.copy()
    data[FADING_RANK] = 0.0
    return replace(residual, data=data)
