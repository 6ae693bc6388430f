"""What exact and variational Gaussian processes share (GPyTorch): parts, training, export.

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

from rovsim import AXES
from rovsim.core.robust import STD_PER_MAD
from rovsim.learning.export import Kernel, export_expansion
from rovsim.learning.learner import Posterior, Predict, Progress, spread_rows
from rovsim.learning.posterior_variance import PosteriorVariance, rbf
from rovsim.learning.scaling import CONSTANT, Scaling, fit_scaling
from rovsim.learning.settings import LearnerSettings

NEARBY = 20  # rows: their median's own noise is a quarter of a row's
SHOWN = 2000  # training rows that show how sure a process is where it was taught


class GaussianSettings(LearnerSettings):
    """What both processes have."""

    # Share of the training rows at which the correction counts fully; beyond what these show it
    # fades, to nothing where nothing was seen. null: it never fades (docs/benchmark_speed.md).
    extrapolation_quantile: float | None = Field(default=1.0, gt=0, le=1)
    # Robust standard deviations by which a target may differ from its neighbours'. null: any
    huberized: float | None = Field(default=4.0, gt=0)


def huberize(X: Array, Y: Array, settings: GaussianSettings) -> Array:
    """Targets (n, 6) brought within `huberized` robust standard deviations of what is usual there.

    Usual is the median of the nearest rows in X (n, d), unscaled. A command that falls inside a
    sample leaves an acceleration far off, and a Gaussian likelihood explains such with lengthscales
    too short for anything else. These are Huber's pseudo-values (Huber & Ronchetti 2009, sec. 7.8).
    """
    if settings.huberized is None or len(X) <= NEARBY:
        return Y
    Z = fit_scaling("standard", X).apply(X)
    _, near = scipy.spatial.cKDTree(Z).query(Z, NEARBY + 1)
    usual = np.median(Y[np.asarray(near)[:, 1:]], axis=1)
    reach = settings.huberized * STD_PER_MAD * np.median(np.abs(Y - usual), axis=0)
    return usual + np.clip(Y - usual, -reach, reach)


def scalings(kind: str, X: Array, Y: Array) -> dict[str, Array]:
    """Scalings of features and targets as arrays, fitted on all training rows.

    A constant target has scale 0: it is predicted as that constant, whatever the process thinks.
    """
    features, targets = fit_scaling(kind, X), fit_scaling("standard", Y)
    return {
        "shift": features.shift,
        "scale": features.scale,
        "target_shift": targets.shift,
        "target_scale": np.where(np.ptp(Y, axis=0) > CONSTANT, targets.scale, 0.0),
    }


def scaled_pairs(arrays: Mapping[str, Array], X: Array, Y: Array) -> tuple[Array, Array]:
    """Scaled features (n, d) and scaled targets (6, n)."""
    scale = arrays["target_scale"]
    targets = Scaling(arrays["target_shift"], np.where(scale > 0.0, scale, 1.0))
    return _features(arrays).apply(X), np.ascontiguousarray(targets.apply(Y).T)


def _features(arrays: Mapping[str, Array]) -> Scaling:
    return Scaling(arrays["shift"], arrays["scale"])


def modules(Z: Array, outputs: int) -> tuple[Any, Any, Any]:
    """Mean, kernel and likelihood for scaled features Z; `outputs` kernels (1 or 6).

    Lengthscales start at sqrt(d) standard deviations, about the distance between two points: at
    GPyTorch's own start (0.7) no point of a 12-dimensional set would see another.
    """
    import torch
    from gpytorch.kernels import RBFKernel, ScaleKernel
    from gpytorch.likelihoods import GaussianLikelihood
    from gpytorch.means import ConstantMean

    batch, d = torch.Size([] if outputs == 1 else [outputs]), Z.shape[1]
    kernel = ScaleKernel(RBFKernel(ard_num_dims=d, batch_shape=batch), batch_shape=batch)
    start = np.sqrt(d) * fit_scaling("standard", Z).scale
    kernel.base_kernel.lengthscale = torch.as_tensor(start).expand(*batch, 1, d)
    # its noise stays above 1e-4 of the targets' variance: 1 % of their size, and well conditioned
    likelihood = GaussianLikelihood(batch_shape=batch)
    return ConstantMean(batch_shape=torch.Size([len(AXES)])), kernel, likelihood


def optimise(
    parameters: list, loss: Callable[[], Any], rounds: int, rate: float, progress: Progress
) -> float:
    """Minimise `loss` with Adam, its rate falling linearly to a tenth; returns the last loss."""
    import torch

    adam = torch.optim.Adam(parameters, lr=rate)
    value = float("nan")
    for done in range(rounds):
        adam.param_groups[0]["lr"] = rate * (1.0 - 0.9 * done / rounds)
        adam.zero_grad()
        now = loss()
        now.backward()
        adam.step()
        value = float(now.detach())
        progress(done + 1, rounds)
    return value


def hyperparameters(model: Any) -> dict[str, Array]:
    """Lengthscale (b, d), outputscale (b,), noise (b,) and mean (6,), in scaled units; b 1 or 6."""

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
    """Give `model` the values that `hyperparameters` returned."""
    import torch

    def into(name: str, like: Any) -> Any:
        return torch.as_tensor(arrays[name]).reshape(like.shape)

    kernel = model.covar
    kernel.base_kernel.lengthscale = into("lengthscale", kernel.base_kernel.lengthscale)
    kernel.outputscale = into("outputscale", kernel.outputscale)
    model.likelihood.noise = into("noise", model.likelihood.noise)
    model.mean.constant.data = into("mean", model.mean.constant)


def library_predictor(model: Any, arrays: Mapping[str, Array]) -> Predict:
    """GPyTorch's own predicted mean, from unscaled features; scaled here and nowhere else."""
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
    """GPyTorch's own mean and variance; `fast`: its LOVE approximation (Pleiss et al. 2018).

    Variances are those of the process, without noise.
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
            found = model(Z)
            mean, variance = found.mean.numpy().T, found.variance.numpy().T
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
    """Kernel expansion around scaled points Z (n, d) with weights (6, n) in scaled units."""
    mean = arrays["target_shift"] + arrays["target_scale"] * arrays["mean"]
    scale = arrays["target_scale"] * arrays["outputscale"]
    prior = arrays["target_scale"] * scale
    parts = len(arrays["lengthscale"])
    columns = np.split((weights * scale[:, None]).T, parts, axis=1)
    kernels = [
        Kernel(Z, *of_one)
        for of_one in zip(
            arrays["lengthscale"], columns, np.split(prior, parts), variances, strict=True
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
    """The same, fading beyond what the training features X (n, d) show."""
    if settings.extrapolation_quantile is None:
        return list(variances)
    some = _features(arrays).apply(X[spread_rows(len(X), SHOWN, seed=0)])
    return [
        one.faded_from(rbf(some, points, lengthscale), settings.extrapolation_quantile)
        for one, lengthscale in zip(variances, arrays["lengthscale"], strict=True)
    ]
