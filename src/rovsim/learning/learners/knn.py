"""k nearest neighbours (scikit-learn): the mean residual of the most similar training rows."""

from typing import Literal, Mapping

import numpy as np
import scipy
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core.errors import BadInput
from rovsim.dynamics.learned.layout import MAX_NEIGHBOURS
from rovsim.learning.cross_validation import FOLDS, split_rows
from rovsim.learning.export import export_neighbours
from rovsim.learning.learner import (
    Learner,
    Predict,
    Progress,
    Trained,
    spread_rows,
)
from rovsim.learning.scaling import MIN_SPREAD, Scaling, fit_scaling
from rovsim.learning.settings import LearnerSettings

CANDIDATE_K = (3, 5, 10, 20, 30)


class KnnSettings(LearnerSettings):
    """Settings of k nearest neighbours in scaled features."""

    kind: Literal["knn"] = "knn"
    # null: the number that predicts left-out stretches of the training runs best
    k: int | None = Field(default=None, ge=1, le=MAX_NEIGHBOURS)
    # with inverse distances the prediction is continuous where the nearest point changes
    weights: Literal["uniform", "distance"] = "distance"


def fit(X: Array, Y: Array, settings: KnnSettings, seed: int, progress: Progress) -> Trained:
    """Store the training rows, and choose k. See `rovsim.learning.learner.train`."""
    scaling = fit_scaling(settings.features.scaling, X)
    rows = spread_rows(len(X), settings.max_points, seed)
    if len(rows) < (settings.k or 1):
        raise BadInput(
            f"{len(rows)} training rows",
            where="residual knn",
            expected=f"at least k = {settings.k}",
            remedy="Record longer, or lower k (and max_points not below it).",
        )
    Z, Y = scaling.apply(X[rows]), Y[rows]
    k = settings.k or best_k(Z, Y, settings.weights)
    settings = settings.model_copy(update={"k": k})
    arrays = {"points": Z, "targets": Y, "shift": scaling.shift, "scale": scaling.scale}
    data = export_neighbours(settings.features, scaling, Z, Y, k, settings.weights)
    progress(1, 1)
    info = {"points": len(rows), "k": k}
    return Trained(settings, data, arrays, info)


def best_k(Z: Array, Y: Array, weights: str) -> int:
    """Choose the number of neighbours that predicts left-out stretches of the rows best.

    A single neighbour passes on its measurement noise, which a mean of k reduces by sqrt(k); too
    many neighbours blur the residual.

    Args:
        Z: scaled features (n, d), rows in the order of time.
        Y: targets (n, 6), m/s2 and rad/s2.
        weights: `uniform`, or `distance` for inverse distances.
    """
    candidates = [k for k in CANDIDATE_K if k <= len(Z) - -(-len(Z) // FOLDS)]
    if len(candidates) < 2:
        return max(1, min(CANDIDATE_K[0], len(Z)))
    scale = np.maximum(np.std(Y, axis=0), MIN_SPREAD)
    errors = np.zeros(len(candidates))
    for out in split_rows(len(Z)):
        training = np.setdiff1d(np.arange(len(Z)), out)
        distance, nearest = map(
            np.asarray, scipy.spatial.cKDTree(Z[training]).query(Z[out], candidates[-1])
        )
        share = np.ones_like(distance) if weights == "uniform" else 1.0 / (distance + MIN_SPREAD)
        sums = np.cumsum(share[..., None] * Y[training][nearest], axis=1)
        for i, k in enumerate(candidates):
            mean = sums[:, k - 1] / share[:, :k].sum(axis=1)[:, None]
            errors[i] += np.sum(((mean - Y[out]) / scale) ** 2)
    return candidates[int(np.argmin(errors))]


def library_from(arrays: Mapping[str, Array], settings: KnnSettings) -> Predict:
    """Rebuild scikit-learn's own prediction from the stored training rows."""
    from sklearn.neighbors import KNeighborsRegressor

    scaling = Scaling(arrays["shift"], arrays["scale"])
    # a tree measures distances directly; brute force expands |a - b|^2 and loses exact hits
    library = KNeighborsRegressor(settings.k, weights=settings.weights, algorithm="kd_tree")
    library.fit(arrays["points"], arrays["targets"])
    return lambda X: np.asarray(library.predict(scaling.apply(X)))


LEARNER = Learner("KNN", "nearest neighbours", KnnSettings, fit, library_from)
