"""Exact Gaussian process (GPyTorch): a smooth residual, whose variance grows away from the data."""

from typing import Any, Literal, Mapping, Sequence

import numpy as np
import scipy
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core.axes import AXES
from rovsim.dynamics.learned.layout import MAX_POINTS
from rovsim.learning import gaussian
from rovsim.learning.cross_validation import noise_factor
from rovsim.learning.determinism import seeded_torch
from rovsim.learning.learner import (
    Learner,
    Posterior,
    Predict,
    Progress,
    Trained,
    spread_rows,
)
from rovsim.learning.posterior_variance import PosteriorVariance, decompose_exact, rbf

Spectrum = tuple[Array, Array]  # eigenvalues (n,) and eigenvectors (n, n) of a kernel matrix


class GpSettings(gaussian.GaussianSettings):
    """Settings of exact Gaussian processes, one for each axis."""

    kind: Literal["gp"] = "gp"
    # independent: each axis has its own lengthscales and noise. shared: one kernel for all six,
    # six times cheaper to evaluate
    kernel: Literal["independent", "shared"] = "independent"
    max_points: int | None = Field(
        default=1500, ge=1, le=MAX_POINTS
    )  # cost: n^3 to condition, n to evaluate
    # rows on which hyperparameters are found: a few numbers need fewer rows than the posterior
    tuning_points: int = Field(default=500, ge=1)
    iterations: int = Field(default=60, ge=1)  # the likelihood is flat after about 50
    learning_rate: float = Field(default=0.1, gt=0)  # Adam on log-like parameters of order 1


def fit(X: Array, Y: Array, settings: GpSettings, seed: int, progress: Progress) -> Trained:
    """Tune hyperparameters on some rows, and condition the process on more of them.

    See `rovsim.learning.learner.train` for the arguments.
    """
    Y = gaussian.huberize(X, Y, settings)
    rows = spread_rows(len(X), settings.max_points, seed)
    tuning_rows = rows[spread_rows(len(rows), settings.tuning_points, seed)]
    arrays = gaussian.scalings(settings.features.scaling, X, Y)
    with seeded_torch(seed):
        model = _model(*gaussian.scaled_pairs(arrays, X[tuning_rows], Y[tuning_rows]), settings)
        loss = _tune(model, settings, progress)
        Z, T = gaussian.scaled_pairs(arrays, X[rows], Y[rows])
        arrays |= gaussian.hyperparameters(model) | {"points": Z, "targets": T}
        spectra = [scipy.linalg.eigh(rbf(Z, Z, scale)) for scale in arrays["lengthscale"]]
        arrays["noise"] *= _factors(arrays, spectra)
        gaussian.set_hyperparameters(model, arrays)
        _condition(model, Z, T)
        gaussian.library_predictor(model, arrays)  # solves for the weights
        weights = model.prediction_strategy.mean_cache.numpy()
    variances = gaussian.fade_beyond(_posterior_variances(arrays, spectra), arrays, Z, X, settings)
    data = gaussian.export(settings, arrays, Z, weights, variances)
    info = {"points": len(rows), "tuning_points": len(tuning_rows), "loss": loss}
    info |= {name: arrays[name].tolist() for name in ("lengthscale", "outputscale", "noise")}
    return Trained(settings, data, arrays, info)


def library_from(arrays: Mapping[str, Array], settings: GpSettings) -> Predict:
    """Rebuild GPyTorch's own prediction from hyperparameters and training rows."""
    with seeded_torch(0):
        model = _model(arrays["points"], arrays["targets"], settings)
        gaussian.set_hyperparameters(model, arrays)
        return gaussian.library_predictor(model, arrays)


def posterior_from(
    arrays: Mapping[str, Array], settings: GpSettings, fast: bool = False
) -> Posterior:
    """Rebuild GPyTorch's own mean and variance; with `fast`, its LOVE approximation."""
    with seeded_torch(0):
        model = _model(arrays["points"], arrays["targets"], settings)
        gaussian.set_hyperparameters(model, arrays)
        return gaussian.library_posterior(model, arrays, fast)


def _factors(arrays: Mapping[str, Array], spectra: Sequence[Spectrum]) -> Array:
    """Factor (b,) by which the noise of each of b kernels is raised; see `noise_factor`."""
    errors = np.split(arrays["targets"] - arrays["mean"][:, None], len(spectra))
    kernels = zip(spectra, errors, arrays["outputscale"], arrays["noise"], strict=True)
    return np.array([noise_factor(*spectrum, *rest) for spectrum, *rest in kernels])


def _posterior_variances(
    arrays: Mapping[str, Array], spectra: Sequence[Spectrum]
) -> list[PosteriorVariance]:
    """Make the posterior variance of each kernel's process."""
    noise = arrays["noise"] / arrays["outputscale"]
    return [
        decompose_exact(*pair, float(ratio)) for pair, ratio in zip(spectra, noise, strict=True)
    ]


def _model(Z: Array, T: Array, settings: GpSettings) -> Any:
    """Make the GPyTorch model of scaled features Z (n, d) and scaled targets T (6, n)."""
    import torch
    from gpytorch.distributions import MultivariateNormal
    from gpytorch.models import ExactGP

    mean, kernel, likelihood = gaussian.modules(Z, 1 if settings.kernel == "shared" else len(AXES))

    class Model(ExactGP):
        def __init__(self) -> None:
            super().__init__(torch.as_tensor(Z), torch.as_tensor(T), likelihood)
            self.mean, self.covar = mean, kernel

        def forward(self, z: Any) -> Any:
            return MultivariateNormal(self.mean(z), self.covar(z))

    return Model()


def _tune(model: Any, settings: GpSettings, progress: Progress) -> float:
    """Maximise the log marginal likelihood, summed over the axes.

    Returns:
        Minus the log marginal likelihood per row, at the last step.
    """
    from gpytorch.mlls import ExactMarginalLogLikelihood

    model.train()
    (Z,), T = model.train_inputs, model.train_targets
    likelihood = ExactMarginalLogLikelihood(model.likelihood, model)

    def independent() -> Any:
        return -likelihood(model(Z), T).sum()

    def shared() -> Any:
        # one factorisation serves all axes; GPyTorch's own class would repeat it six times
        prior = model(Z)
        K = prior.lazy_covariance_matrix.add_diagonal(model.likelihood.noise)
        error = (T - prior.mean).mT
        square, determinant = K.inv_quad_logdet(error, logdet=True)
        return 0.5 * (square + len(AXES) * determinant) / len(Z)

    loss = shared if settings.kernel == "shared" else independent
    rounds, rate = settings.iterations, settings.learning_rate
    return gaussian.optimise(list(model.parameters()), loss, rounds, rate, progress)


def _condition(model: Any, Z: Array, T: Array) -> None:
    """Replace the training rows of a model by scaled features Z (n, d) and targets T (6, n)."""
    import torch

    model.set_train_data(torch.as_tensor(Z), torch.as_tensor(T), strict=False)


LEARNER = Learner("GP", "a Gaussian process", GpSettings, fit, library_from, posterior_from)
