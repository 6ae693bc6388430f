"""What exact and variational Gaussian processes share: GPyTorch modules, training, export.

Both see scaled features and targets of mean 0 and standard deviation 1, and predict the mean
mean_j + s_j^2 sum_i w_ij exp(-|(z - z_i) / l_j|^2 / 2): an RBF kernel with one lengthscale per
feature (Rasmussen & Williams 2006, eqs. 2.25 and 5.1).
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import scipy
from numpy import ndarray as Array
from pydantic import Field

from rovsim.core.axes import AXES
from rovsim.core.robust import STD_PER_MAD
from rovsim.learning.export import Kernel, export_expansion
from rovsim.learning.learner import Posterior, Predict, Progress, spread_rows
from rovsim.learning.posterior_variance import PosteriorVariance, rbf
from rovsim.learning.scaling import MIN_SPREAD, Scaling, fit_scaling
from rovsim.learning.settings import LearnerSettings

NEAREST_ROWS = 20  # their median's own noise is a quarter of a row's
POSTERIOR_ROWS = 2000  # of training that show how sure a process is where it was taught


class GaussianSettings(LearnerSettings):
    """Settings that exact and variational Gaussian processes share."""

    # Share of the training rows at which the correction counts fully; beyond what these show it
    # fades, to nothing where nothing was seen. null: it never fades (docs/benchmark_speed.md).
    extrapolation_quantile: float | None = Field(default=1.0, gt=0, le=1)
    # Robust standard deviations by which a target may differ from its neighbours'. null: any
    huberized: float | None = Field(default=4.0, gt=0)


def huberize(X: Array, Y: Array, settings: GaussianSettings) -> Array:
    """Limit how far targets differ from those of similar rows.

    A command that changes within a sampling period leaves an outlier in the acceleration. A
    Gaussian likelihood explains outliers by lengthscales that are too short for all other rows. So
    targets are limited to `huberized` robust standard deviations from the median of the nearest
    rows. These are Huber's pseudo-values (Huber & Ronchetti 2009, sec. 7.8).

    Args:
        X: unscaled features (n, d).
        Y: targets (n, 6), m/s2 and rad/s2.
        settings: with the limit, which may be None.
    """
    if settings.huberized is None or len(X) <= NEAREST_ROWS:
        return Y
    Z = fit_scaling("standard", X).apply(X)
    _, neighbours = scipy.spatial.cKDTree(Z).query(Z, NEAREST_ROWS + 1)
    medians = np.median(Y[np.asarray(neighbours)[:, 1:]], axis=1)
    reach = settings.huberized * STD_PER_MAD * np.median(np.abs(Y - medians), axis=0)
    return medians + np.clip(Y - medians, -reach, reach)


def scalings(kind: str, X: Array, Y: Array) -> dict[str, Array]:
    """Fit the scalings of features and targets on all training rows.

    A constant target gets the scale 0, so that every prediction is that constant.

    Args:
        kind: scaling of the features, see `fit_scaling`.
        X: unscaled features (n, d).
        Y: targets (n, 6), m/s2 and rad/s2.

    Returns:
        Arrays `shift` and `scale` (d,), `target_shift` and `target_scale` (6,).
    """
    features, targets = fit_scaling(kind, X), fit_scaling("standard", Y)
    return {
        "shift": features.shift,
        "scale": features.scale,
        "target_shift": targets.shift,
        "target_scale": np.where(np.ptp(Y, axis=0) > MIN_SPREAD, targets.scale, 0.0),
    }


def scaled_pairs(arrays: Mapping[str, Array], X: Array, Y: Array) -> tuple[Array, Array]:
    """Scale features (n, d) and targets (n, 6); returns them as (n, d) and transposed (6, n)."""
    scale = arrays["target_scale"]
    targets = Scaling(arrays["target_shift"], np.where(scale > 0.0, scale, 1.0))
    return _features(arrays).apply(X), np.ascontiguousarray(targets.apply(Y).T)


def _features(arrays: Mapping[str, Array]) -> Scaling:
    """The scaling of the features, from the arrays of `scalings`."""
    return Scaling(arrays["shift"], arrays["scale"])


def modules(Z: Array, outputs: int) -> tuple[Any, Any, Any]:
    """Make GPyTorch's mean, kernel and likelihood for scaled features.

    Lengthscales start at sqrt(d) standard deviations, about the distance between two points. At
    GPyTorch's own start (0.7) no two points of a 12-dimensional set would be correlated.

    Args:
        Z: scaled features (n, d).
        outputs: number of kernels: 1 for all six axes, or 6.
    """
    import torch
    from gpytorch.kernels import RBFKernel, ScaleKernel
    from gpytorch.likelihoods import GaussianLikelihood
    from gpytorch.means import ConstantMean

    batch, d = torch.Size([] if outputs == 1 else [outputs]), Z.shape[1]
    kernel = ScaleKernel(RBFKernel(ard_num_dims=d, batch_shape=batch), batch_shape=batch)
    start = np.sqrt(d) * fit_scaling("standard", Z).scale
    kernel.base_kernel.lengthscale = torch.as_tensor(start).expand(*batch, 1, d)
    # GPyTorch keeps this noise above 1e-4 of the targets' variance (1 % of their standard
    # deviation), so that the kernel matrix is well conditioned
    likelihood = GaussianLikelihood(batch_shape=batch)
    return ConstantMean(batch_shape=torch.Size([len(AXES)])), kernel, likelihood


def optimise(
    parameters: list, loss: Callable[[], Any], rounds: int, rate: float, progress: Progress
) -> float:
    """Minimise a loss with Adam, whose learning rate falls linearly to a tenth.

    Args:
        parameters: PyTorch parameters that the loss depends on.
        loss: computes the loss as a scalar tensor.
        rounds: number of steps.
        rate: initial learning rate.
        progress: called with the number of steps done and their total number.

    Returns:
        The loss before the last step.
    """
    import torch

    adam = torch.optim.Adam(parameters, lr=rate)
    value = float("nan")
    for k in range(rounds):
        adam.param_groups[0]["lr"] = rate * (1.0 - 0.9 * k / rounds)
        adam.zero_grad()
        current = loss()
        current.backward()
        adam.step()
        value = float(current.detach())
        progress(k + 1, rounds)
    return value


def hyperparameters(model: Any) -> dict[str, Array]:
    """Read the hyperparameters of a GPyTorch model of b kernels (1 or 6), in scaled units.

    Returns:
        Arrays `lengthscale` (b, d), `outputscale` (b,), `noise` (b,) and `mean` (6,).
    """

    def of(tensor: Any) -> Array:
        return tensor.detach().numpy().copy()

    lengthscale = of(model.covar.base_kernel.lengthscale)
    return {
        "lengthscale": lengthscale.reshape(-1, lengthscale.shape[-1]),
        "outputscale": of(model.covar.outputscale).reshape(-1),
        "noise": of(model.likelihood.noise).reshape(-1),
        "mean": of(model.mean.constant),
    }


def set_hyperparameters(model: Any, arrays: Mapping[str, Array]) -> None:
    """Set the hyperparameters of a GPyTorch model to those that `hyperparameters` returned."""
    import torch

    def into(name: str, like: Any) -> Any:
        return torch.as_tensor(arrays[name]).reshape(like.shape)

    kernel = model.covar
    kernel.base_kernel.lengthscale = into("lengthscale", kernel.base_kernel.lengthscale)
    kernel.outputscale = into("outputscale", kernel.outputscale)
    model.likelihood.noise = into("noise", model.likelihood.noise)
    model.mean.constant.data = into("mean", model.mean.constant)


def library_predictor(model: Any, arrays: Mapping[str, Array]) -> Predict:
    """Make a function that predicts with GPyTorch itself.

    Args:
        model: a GPyTorch model of scaled features and targets.
        arrays: scalings, see `scalings`.

    Returns:
        Function from unscaled features (n, d) to the mean acceleration (n, 6), m/s2 and rad/s2.
    """
    import torch
    from gpytorch import settings

    features = _features(arrays)
    model.eval()

    def predict(X: Array) -> Array:
        Z = torch.as_tensor(features.apply(X))
        with torch.no_grad(), settings.debug(False), settings.skip_posterior_variances():
            mean = model(Z).mean.numpy()
        return mean.T * arrays["target_scale"] + arrays["target_shift"]

    predict(arrays["shift"][None])  # GPyTorch solves for its weights at the first call
    return predict


def library_posterior(model: Any, arrays: Mapping[str, Array], fast: bool = False) -> Posterior:
    """Make a function that computes mean and variance with GPyTorch itself.

    Args:
        model: a GPyTorch model of scaled features and targets.
        arrays: scalings, see `scalings`.
        fast: whether variances are those of the LOVE approximation (Pleiss et al. 2018).

    Returns:
        Function from unscaled features (n, d) to mean (n, 6) and variance (n, 6), in m/s2 and
        rad/s2 and their squares. The variance is that of the latent function, without noise.
    """
    import torch
    from gpytorch import settings

    features = _features(arrays)
    model.eval()

    def predict(X: Array) -> tuple[Array, Array]:
        Z = torch.as_tensor(features.apply(X))
        # its path for small kernels does not take one kernel for six outputs
        lazy = settings.max_eager_kernel_size(1)
        with torch.no_grad(), settings.debug(False), settings.fast_pred_var(fast), lazy:
            posterior = model(Z)
            mean, variance = posterior.mean.numpy().T, posterior.variance.numpy().T
        scale = arrays["target_scale"]
        return mean * scale + arrays["target_shift"], variance * scale**2

    predict(arrays["shift"][None])
    return predict


def export(
    settings: GaussianSettings,
    arrays: Mapping[str, Array],
    Z: Array,
    weights: Array,
    variances: Sequence[PosteriorVariance],
) -> Array:
    """Export a Gaussian process as a kernel expansion in units of the targets.

    Args:
        settings: with the features, and whether the correction fades.
        arrays: scalings and hyperparameters.
        Z: training or inducing points (n, d), scaled features.
        weights: w (6, n) of the scaled mean, mean + outputscale w k, where k is 1 at distance 0.
        variances: of each kernel.
    """
    mean = arrays["target_shift"] + arrays["target_scale"] * arrays["mean"]
    scale = arrays["target_scale"] * arrays["outputscale"]
    prior = arrays["target_scale"] * scale
    count = len(arrays["lengthscale"])
    columns = np.split((weights * scale[:, None]).T, count, axis=1)
    kernels = [
        Kernel(Z, *fields)
        for fields in zip(
            arrays["lengthscale"], columns, np.split(prior, count), variances, strict=True
        )
    ]
    fades = settings.extrapolation_quantile is not None
    return export_expansion(settings.features, _features(arrays), mean, kernels, fades)


def fade_beyond(
    variances: Sequence[PosteriorVariance],
    arrays: Mapping[str, Array],
    points: Array,
    X: Array,
    settings: GaussianSettings,
) -> list[PosteriorVariance]:
    """Set the limits beyond which the correction fades, from the training features.

    Args:
        variances: of each kernel.
        arrays: scalings and hyperparameters.
        points: training or inducing points (n, d), scaled.
        X: unscaled features (rows, d) of the training set.
        settings: with the share of the training rows at which the correction counts fully.

    Returns:
        The variances with these limits; unchanged where the correction never fades.
    """
    if settings.extrapolation_quantile is None:
        return list(variances)
    sample = _features(arrays).apply(X[spread_rows(len(X), POSTERIOR_ROWS, seed=0)])
    return [
        variance.faded_from(rbf(sample, points, lengthscale), settings.extrapolation_quantile)
        for variance, lengthscale in zip(variances, arrays["lengthscale"], strict=True)
    ]
