"""Sparse variational Gaussian process (GPyTorch; Hensman et al. 2015): all rows, few points."""

from time import perf_counter
from typing import Any, Literal, Mapping

import numpy as np
from numpy import ndarray as Array
from pydantic import Field

from rovsim.residual import gaussian
from rovsim.residual.determinism import seeded_torch
from rovsim.residual.export import AXES
from rovsim.residual.learner import (
    Learner,
    LearnerSettings,
    Predict,
    Progress,
    Trained,
    spread_rows,
)


class SvgpSettings(LearnerSettings):
    """Sparse variational Gaussian process, one per axis, around common inducing points."""

    kind: Literal["svgp"] = "svgp"
    inducing: int = Field(default=100, ge=1)  # points it thinks with; cost grows with their cube
    batch: int = Field(default=512, ge=1)  # rows per step
    iterations: int = Field(default=250, ge=1)  # 12 passes over 11,000 rows
    learning_rate: float = Field(default=0.1, gt=0)  # Adam; whitened parameters of order 1


def fit(X: Array, Y: Array, settings: SvgpSettings, seed: int, progress: Progress) -> Trained:
    """Maximise the evidence bound by minibatches. See `rovsim.residual.learner.train`."""
    start = perf_counter()
    rows = spread_rows(len(X), settings.max_points, seed)
    arrays = gaussian.scalings(settings.features.scaling, X, Y)
    Z, T = gaussian.scaled_pairs(arrays, X[rows], Y[rows])
    with seeded_torch(seed):
        model = _model(_centres(Z, settings.inducing, seed))
        loss = _train(model, Z, T, settings, progress)
        arrays |= gaussian.hyperparameters(model) | _variational(model)
        library = gaussian.library_predictor(model, arrays)
        weights = _weights(model)
    data = gaussian.export(settings.features, arrays, arrays["inducing"], weights)
    info = {"points": len(arrays["inducing"]), "rows": len(rows), "loss": loss}
    info |= {name: arrays[name].tolist() for name in ("lengthscale", "outputscale", "noise")}
    info["seconds"] = round(perf_counter() - start, 3)
    return Trained(settings, data, arrays, library, info)


def library_from(arrays: Mapping[str, Array], settings: SvgpSettings) -> Predict:
    """GPyTorch's own model, with its hyperparameters and variational distribution."""
    import torch

    with seeded_torch(0):
        model = _model(arrays["inducing"])
        gaussian.set_hyperparameters(model, arrays)
        strategy = model.variational_strategy
        distribution = strategy._variational_distribution
        distribution.variational_mean.data = torch.as_tensor(arrays["variational_mean"])
        distribution.chol_variational_covar.data = torch.as_tensor(arrays["variational_root"])
        strategy.variational_params_initialized.fill_(1)  # else the first call would reset them
        return gaussian.library_predictor(model, arrays)


def _centres(Z: Array, number: int, seed: int) -> Array:
    """Inducing points: centres of a seeded k-means of the scaled features, at most one a row."""
    from sklearn.cluster import KMeans

    distinct = np.unique(Z, axis=0)
    if len(distinct) <= number:
        return distinct
    return KMeans(number, n_init=1, max_iter=20, random_state=seed).fit(Z).cluster_centers_


def _model(centres: Array) -> Any:
    import torch
    from gpytorch.distributions import MultivariateNormal
    from gpytorch.models import ApproximateGP
    from gpytorch.variational import CholeskyVariationalDistribution, VariationalStrategy

    mean, kernel, likelihood = gaussian.modules(centres, AXES)

    class Model(ApproximateGP):
        def __init__(self) -> None:
            q = CholeskyVariationalDistribution(len(centres), batch_shape=torch.Size([AXES]))
            super().__init__(VariationalStrategy(self, torch.as_tensor(centres), q))
            self.mean, self.covar, self.likelihood = mean, kernel, likelihood

        def forward(self, z: Any) -> Any:
            return MultivariateNormal(self.mean(z), self.covar(z))

    return Model()


def _train(model: Any, Z: Array, T: Array, settings: SvgpSettings, progress: Progress) -> float:
    """Maximise the evidence lower bound, summed over the axes; returns minus it per row."""
    import torch
    from gpytorch.mlls import VariationalELBO

    model.train()
    bound = VariationalELBO(model.likelihood, model, num_data=len(Z))
    z, t = torch.as_tensor(Z), torch.as_tensor(T)
    batches = _batches(len(Z), min(settings.batch, len(Z)))

    def loss() -> Any:
        rows = next(batches)
        return -bound(model(z[rows]), t[:, rows]).sum()

    rounds, rate = settings.iterations, settings.learning_rate
    return gaussian.optimise(list(model.parameters()), loss, rounds, rate, progress)


def _batches(rows: int, size: int) -> Any:
    """Endless minibatches: shuffled passes over all rows, the incomplete last batch left out."""
    import torch

    while True:
        yield from torch.randperm(rows)[: rows // size * size].reshape(-1, size)


def _variational(model: Any) -> dict[str, Array]:
    distribution = model.variational_strategy._variational_distribution
    return {
        "inducing": model.variational_strategy.inducing_points.detach().numpy().copy(),
        "variational_mean": distribution.variational_mean.detach().numpy().copy(),
        "variational_root": distribution.chol_variational_covar.detach().numpy().copy(),
    }


def _weights(model: Any) -> Array:
    """w (6, n) of the mean k(z, Z) w: with K_ZZ = L L' and whitened mean m, w = L^-T m."""
    import torch

    strategy = model.variational_strategy
    with torch.no_grad():
        K = model.covar(strategy.inducing_points).add_jitter(strategy.jitter_val).to_dense()
        m = strategy._variational_distribution.variational_mean[..., None]
        w = torch.linalg.solve_triangular(torch.linalg.cholesky(K).mT, m, upper=True)
    return w[..., 0].numpy()


LEARNER = Learner(SvgpSettings, fit, library_from)
