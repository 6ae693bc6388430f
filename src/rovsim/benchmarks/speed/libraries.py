"""The libraries' own calls, scaled as ours: features (1, d) to residual accelerations (1, 6)."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.learned.residual import Residual
from rovsim.learning.learner import Predict, learner, library_of, settings_of
from rovsim.learning.scaling import Scaling

Ways = dict[str, Predict]


def neighbours(residual: Residual) -> Ways:
    """Return scikit-learn's prediction, and ours with the trees of SciPy and pykdtree.

    The latter take the same inverse-distance mean of the k nearest points.
    """
    from pykdtree.kdtree import KDTree
    from scipy.spatial import cKDTree

    points, targets, scaling = _training_points(residual)
    k = residual.settings["k"]
    with_tree: dict[str, Any] = {"scipy_knn": cKDTree(points), "pykdtree_knn": KDTree(points)}
    return {
        "sklearn_knn": library_of(residual),
        **{name: _mean_of(tree.query, targets, scaling, k) for name, tree in with_tree.items()},
    }


def _training_points(residual: Residual) -> tuple[Array, Array, Scaling]:
    a = residual.arrays
    return a["points"], a["targets"], Scaling(a["shift"], a["scale"])


def _mean_of(query: Callable[..., Any], targets: Array, scaling: Scaling, k: int) -> Predict:
    """Make a prediction from a query for neighbours: their mean, weighted by inverse distance."""

    def predict(X: Array) -> Array:
        distance, rows = query(scaling.apply(X), k=k)
        distance, rows = distance.reshape(-1, k), rows.reshape(-1, k)
        with np.errstate(divide="ignore"):
            weight = 1.0 / distance
        exact = np.isinf(weight).any(axis=1)
        weight[exact] = np.isinf(weight[exact])
        return (weight[..., None] * targets[rows]).sum(1) / weight.sum(1)[:, None]

    return predict


def means(residual: Residual) -> Ways:
    """Return the means of GPyTorch, and with one kernel those of scikit-learn and NumPy.

    All have the same hyperparameters; NumPy multiplies stored weights.
    """
    ways = {"gpytorch_mean": library_of(residual)}
    if len(residual.arrays["lengthscale"]) == 1:
        ways |= {"sklearn_gp_mean": _sklearn(residual), "numpy_gp_mean": _numpy(residual)}
    return ways


def variances(residual: Residual) -> dict[str, Callable[[Array], tuple[Array, Array]]]:
    """Return GPyTorch's mean and variance, exact and by LOVE."""
    posterior = learner(residual.kind).posterior_from
    assert posterior is not None
    return {
        "gpytorch_variance": posterior(residual.arrays, settings_of(residual)),
        "gpytorch_love": posterior(residual.arrays, settings_of(residual), fast=True),
    }


def _sklearn(residual: Residual) -> Predict:
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel

    a, (points, targets, scaling) = residual.arrays, _training_points(residual)
    kernel = ConstantKernel(a["outputscale"][0]) * RBF(a["lengthscale"][0])
    process = GaussianProcessRegressor(kernel, alpha=float(a["noise"][0]), optimizer=None)
    process.fit(points, targets.T - a["mean"])

    def predict(X: Array) -> Array:
        mean = process.predict(scaling.apply(X)) + a["mean"]
        return mean * a["target_scale"] + a["target_shift"]

    return predict


def _numpy(residual: Residual) -> Predict:
    a, (points, targets, scaling) = residual.arrays, _training_points(residual)
    lengthscale, outputscale = a["lengthscale"][0], a["outputscale"][0]
    Z = points / lengthscale
    squares = (Z**2).sum(1)
    gram = outputscale * np.exp(-0.5 * np.maximum(squares[:, None] + squares - 2.0 * Z @ Z.T, 0.0))
    gram[np.diag_indices(len(Z))] = outputscale + a["noise"][0]
    weights = outputscale * np.linalg.solve(gram, targets.T - a["mean"]) * a["target_scale"]
    mean = a["mean"] * a["target_scale"] + a["target_shift"]

    def predict(X: Array) -> Array:
        z = scaling.apply(X) / lengthscale
        k = np.exp(-0.5 * ((z[:, None] - Z) ** 2).sum(2))
        return mean + k @ weights

    return predict
