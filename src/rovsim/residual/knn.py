"""k nearest neighbours (scikit-learn): the mean residual of the most similar moments seen."""

from time import perf_counter
from typing import Literal, Mapping

import numpy as np
from numpy import ndarray as Array
from pydantic import Field

from rovsim.errors import BadInput
from rovsim.residual.export import export_neighbours
from rovsim.residual.layout import MOST_NEIGHBOURS
from rovsim.residual.learner import (
    Learner,
    LearnerSettings,
    Predict,
    Progress,
    Trained,
    spread_rows,
)
from rovsim.residual.scaling import Scaling, fit_scaling


class KnnSettings(LearnerSettings):
    """k nearest neighbours in scaled features."""

    kind: Literal["knn"] = "knn"
    # one neighbour repeats its measurement noise; the noise of a mean falls with sqrt(k)
    k: int = Field(default=5, ge=1, le=MOST_NEIGHBOURS)
    # by inverse distance the prediction is continuous while the nearest point changes
    weights: Literal["uniform", "distance"] = "distance"


def fit(X: Array, Y: Array, settings: KnnSettings, seed: int, progress: Progress) -> Trained:
    """Keep the training rows. See `rovsim.residual.learner.train`."""
    start = perf_counter()
    scaling = fit_scaling(settings.features.scaling, X)
    rows = spread_rows(len(X), settings.max_points, seed)
    if len(rows) < settings.k:
        raise BadInput(
            f"{len(rows)} training rows",
            where="residual knn",
            expected=f"at least k = {settings.k}",
            remedy="Record longer, or lower k (and max_points not below it).",
        )
    Z, Y = scaling.apply(X[rows]), Y[rows]
    arrays = {"points": Z, "targets": Y, "shift": scaling.shift, "scale": scaling.scale}
    data = export_neighbours(settings.features, scaling, Z, Y, settings.k, settings.weights)
    library = library_from(arrays, settings)
    progress(1, 1)
    info = {"points": len(rows), "seconds": round(perf_counter() - start, 3)}
    return Trained(settings, data, arrays, library, info)


def library_from(arrays: Mapping[str, Array], settings: KnnSettings) -> Predict:
    """Scikit-learn's own predictor, fitted on the stored points."""
    from sklearn.neighbors import KNeighborsRegressor

    scaling = Scaling(arrays["shift"], arrays["scale"])
    # a tree measures distances directly; brute force expands |a - b|^2 and loses exact hits
    library = KNeighborsRegressor(settings.k, weights=settings.weights, algorithm="kd_tree")
    library.fit(arrays["points"], arrays["targets"])
    return lambda X: np.asarray(library.predict(scaling.apply(X)))


LEARNER = Learner(KnnSettings, fit, library_from)
