"""Sparse variational Gaussian process (GPyTorch; Hensman et al. 2015), around inducing points."""

from typing import Any, Literal, Mapping

import numpy as np
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core.axes import AXES
from rovsim.dynamics.learned.layout import MAX_POINTS
from rovsim.learning import gaussian
from rovsim.learning.determinism import seeded_torch
from rovsim.learning.learner import (
    Learner,
    Posterior,
    Predict,
    Progress,
    Trained,
    spread_rows,
)
from rovsim.learning.posterior_variance import PosteriorVariance, decompose_quadratic


class SvgpSettings(gaussian.GaussianSettings):
    """Settings of sparse variational Gaussian processes, one per axis, same inducing points."""

    kind: Literal["svgp"] = "svgp"
    inducing: int = Field(
        default=100, ge=1, le=MAX_POINTS
    )  # inducing points; the cost grows with the cube of their number
    batch: int = Field(default=512, ge=1)  # rows per step
    iterations: int = Field(default=250, ge=1)  # 12 passes over 11,000 rows
    learning_rate: float = Field(default=0.1, gt=0)  # Adam; whitened parameters of order 1


def fit(X: Array, Y: Array, settings: SvgpSettings, seed: int, progress: Progress) -> Trained:
    """Maximise the evidence lower bound in minibatches. See `rovsim.learning.learner.train`."""
    Y = gaussian.huberize(X, Y, settings)
    rows = spread_rows(len(X), settings.max_points, seed)
    arrays = gaussian.scalings(settings.features.scaling, X, Y)
    Z, T = gaussian.scaled_pairs(arrays, X[rows], Y[rows])
    with seeded_torch(seed):
        model = _model(_centres(Z, settings.inducing, seed))
        loss = _train(model, Z, T, settings, progress)
        arrays |= gaussian.hyperparameters(model) | _variational(model)
        model.eval()
        weights, variances = _weights(model), _posterior_variances(model, arrays)
    variances = gaussian.fade_beyond(variances, arrays, arrays["inducing"], X, settings)
    data = gaussian.export(settings, arrays, arrays["inducing"], weights, variances)
    info = {"points": len(arrays["inducing"]), "rows": len(rows), "loss": loss}
    info |= {name: arrays[name].tolist() for name in ("lengthscale", "outputscale", "noise")}
    return Trained(settings, data, arrays, info)


def library_from(arrays: Mapping[str, Array], settings: SvgpSettings) -> Predict:
    """Rebuild GPyTorch's own prediction from hyperparameters and variational distribution."""
    with seeded_torch(0):
        return gaussian.library_predictor(_rebuilt(arrays), arrays)


def posterior_from(
    arrays: Mapping[str, Array], settings: SvgpSettings, fast: bool = False
) -> Posterior:
    """Rebuild GPyTorch's own mean and variance; with `fast`, its LOVE approximation."""
    with seeded_torch(0):
        return gaussian.library_posterior(_rebuilt(arrays), arrays, fast)


def _rebuilt(arrays: Mapping[str, Array]) -> Any:
    """Rebuild the trained GPyTorch model from its stored arrays."""
    import torch

    model = _model(arrays["inducing"])
    gaussian.set_hyperparameters(model, arrays)
    strategy = model.variational_strategy
    distribution = strategy._variational_distribution
    distribution.variational_mean.data = torch.as_tensor(arrays["variational_mean"])
    distribution.chol_variational_covar.data = torch.as_tensor(arrays["variational_root"])
    strategy.variational_params_initialized.fill_(1)  # else the first call would reset them
    return model


def _centres(Z: Array, number: int, seed: int) -> Array:
    """Choose at most `number` inducing points: cluster centres (seeded k-means) of Z (n, d).

    Where there are no more distinct rows than that, the rows themselves are returned.
    """
    from sklearn.cluster import KMeans

    distinct = np.unique(Z, axis=0)
    if len(distinct) <= number:
        return distinct
    return KMeans(number, n_init=1, max_iter=20, random_state=seed).fit(Z).cluster_centers_


def _model(centres: Array) -> Any:
    """Make the GPyTorch model around inducing points (n, d), in scaled features."""
    import torch
    from gpytorch.distributions import MultivariateNormal
    from gpytorch.models import ApproximateGP
    from gpytorch.variational import CholeskyVariationalDistribution, VariationalStrategy

    mean, kernel, likelihood = gaussian.modules(centres, len(AXES))

    class Model(ApproximateGP):
        def __init__(self) -> None:
            q = CholeskyVariationalDistribution(len(centres), batch_shape=torch.Size([len(AXES)]))
            super().__init__(VariationalStrategy(self, torch.as_tensor(centres), q))
            self.mean, self.covar, self.likelihood = mean, kernel, likelihood

        def forward(self, z: Any) -> Any:
            return MultivariateNormal(self.mean(z), self.covar(z))

    return Model()


def _train(model: Any, Z: Array, T: Array, settings: SvgpSettings, progress: Progress) -> float:
    """Maximise the evidence lower bound, summed over the axes, in minibatches.

    Args:
        model: of `_model`.
        Z: scaled features (n, d).
        T: scaled targets (6, n).
        settings: of the learner.
        progress: called with the number of steps done and their total number.

    Returns:
        Minus the bound per row, at the last step.
    """
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
    """Yield row indices (size,) of minibatches without end: shuffled passes over all rows.

    The incomplete last minibatch of each pass is left out.
    """
    import torch

    while True:
        yield from torch.randperm(rows)[: rows // size * size].reshape(-1, size)


def _variational(model: Any) -> dict[str, Array]:
    """Arrays of the inducing points (n, d) and the variational distribution of a model."""
    distribution = model.variational_strategy._variational_distribution
    return {
        "inducing": model.variational_strategy.inducing_points.detach().numpy().copy(),
        "variational_mean": distribution.variational_mean.detach().numpy().copy(),
        "variational_root": distribution.chol_variational_covar.detach().numpy().copy(),
    }


def _weights(model: Any) -> Array:
    """Compute the weights w (6, n) of the inducing points Z in the mean k(z, Z) w.

    w = L^-T m, with K_ZZ = L L' and the whitened variational mean m.
    """
    import torch

    strategy = model.variational_strategy
    with torch.no_grad():
        m = strategy._variational_distribution.variational_mean[..., None]
        w = torch.linalg.solve_triangular(_root(model).mT, m, upper=True)
    return w[..., 0].numpy()


def _root(model: Any) -> Any:
    """Cholesky factor L (6, n, n) of K_ZZ, as GPyTorch computes it."""
    import torch

    strategy = model.variational_strategy
    K = model.covar(strategy.inducing_points).add_jitter(strategy.jitter_val).to_dense()
    return torch.linalg.cholesky(K)


def _posterior_variances(model: Any, arrays: Mapping[str, Array]) -> list[PosteriorVariance]:
    """Make the posterior variance of each axis: rho = 1 - outputscale k' A k.

    A = L^-T (I - S) L^-1, with K_ZZ = L L' and the whitened variational covariance S.
    """
    import torch

    with torch.no_grad():
        L = _root(model)
        identity = torch.eye(L.shape[-1])
        inverse = torch.linalg.solve_triangular(L, identity, upper=False)
        root = torch.as_tensor(np.tril(arrays["variational_root"]))
        A = (inverse.mT @ (identity - root @ root.mT) @ inverse).numpy()
    return [
        decompose_quadratic(quadratic * scale)
        for quadratic, scale in zip(A, arrays["outputscale"], strict=True)
    ]


LEARNER = Learner(
    "sparse GP", "a sparse Gaussian process", SvgpSettings, fit, library_from, posterior_from
)
