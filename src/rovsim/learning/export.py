"""Turn trained residuals into the arrays that the kernels of `rovsim.dynamics.learned` read."""

from dataclasses import dataclass
from math import sqrt
from typing import Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.dynamics.learned.layout import (
    BLOCKS,
    COUNT,
    DISTANCE,
    EXPANSION,
    FADING_RANK,
    FORMAT,
    HEADER,
    KIND,
    LANES,
    MAX_POINTS,
    NEIGHBOURS,
    OUTPUTS,
    POINTS,
    RANK,
    UNIFORM,
    UNROLL,
    VERSION,
    WEIGHTING,
    WIDTH,
    filled,
)
from rovsim.dynamics.learned.settings import FeatureSettings, blocks_code, feature_names
from rovsim.learning.posterior_variance import PosteriorVariance
from rovsim.learning.scaling import Scaling
from rovsim.learning.tree import packed_tree, side_by_side


@dataclass(frozen=True, eq=False)
class Kernel:
    """A sum of RBF kernels, sum_i weights_i exp(-|(z - points_i) / lengthscale|^2 / 2).

    Attributes:
        points: (n, d) in scaled features, as z is.
        lengthscale: (d,) in scaled features.
        weights: (n, p) of its p outputs, in units of the targets.
        prior: prior variance (p,) of a Gaussian process, in squared units of the targets.
        variance: gives the share of the prior variance that remains. Without `prior` and
            `variance` the sum has no variance, and never fades.
    """

    points: Array
    lengthscale: Array
    weights: Array
    prior: Array | None = None
    variance: PosteriorVariance | None = None


def export_neighbours(
    features: FeatureSettings, scaling: Scaling, Z: Array, Y: Array, k: int, weights: str
) -> Array:
    """Export a mean of the targets of the k nearest training points.

    Args:
        features: settings of the features.
        scaling: of the features.
        Z: scaled features (n, d) of the training points; at equal distance the earlier row counts.
        Y: targets (n, m).
        k: number of neighbours.
        weights: `uniform`, or `distance` for inverse distances.

    Returns:
        The exported residual, see `rovsim.dynamics.learned.layout`.
    """
    header = _header(NEIGHBOURS, features, len(Z), Y.shape[1], k)
    header[WEIGHTING] = DISTANCE if weights == "distance" else UNIFORM
    axes = principal_axes(Z)
    rotated = Z @ axes.T
    tree = packed_tree(rotated)
    parts = [
        header,
        scaling.shift,
        scaling.scale,
        _sheet(axes, filled(len(axes), UNROLL), len(axes)),
        tree.boxes,
        side_by_side(rotated[tree.order]),
        _row(tree.order, filled(len(Z), LANES)),
        Z[tree.order],
        Y[tree.order],
    ]
    return np.concatenate([part.ravel() for part in parts])


def principal_axes(Z: Array) -> Array:
    """Principal axes (d, d) of points (n, d), one a row, that with the largest variance first."""
    return np.linalg.eigh(np.cov(Z.T, ddof=0).reshape(Z.shape[1], -1))[1].T[::-1]


def export_expansion(
    features: FeatureSettings,
    scaling: Scaling,
    mean: Array,
    kernels: Sequence[Kernel],
    fades: bool = False,
) -> Array:
    """Export a constant mean plus sums of RBF kernels.

    Args:
        features: settings of the features.
        scaling: of the features.
        mean: (m,) in units of the targets.
        kernels: one with m outputs, or m with one output each; all with a variance, or none.
        fades: whether the correction fades where it extrapolates.

    Returns:
        The exported residual, see `rovsim.dynamics.learned.layout`.

    Raises:
        BadInput: more points than the scratch of the compiled code has room for.
    """
    points = len(kernels[0].points)
    if points > MAX_POINTS:
        raise BadInput(
            f"{points} points",
            where="kernel expansion of a residual",
            expected=f"at most {MAX_POINTS}",
            remedy="Set residual.max_points, or use svgp.",
        )
    variances = [kernel.variance for kernel in kernels if kernel.variance]
    assert len(variances) in (0, len(kernels))
    header = _header(EXPANSION, features, points, len(mean), len(kernels))
    header[RANK] = max((len(v.spectrum) for v in variances), default=0)
    header[FADING_RANK] = max((v.fading_rank for v in variances), default=0) if fades else 0
    parts = [_part(kernel, scaling, int(header[RANK])) for kernel in kernels]
    return np.concatenate([header, mean, *parts])


def _part(kernel: Kernel, scaling: Scaling, rank: int) -> Array:
    """Flatten one kernel in the order of `layout`; its variance is filled up to `rank` vectors."""
    n, share = kernel.weights.shape
    variance = kernel.variance or PosteriorVariance(0.0, np.zeros(0), np.zeros((0, n)), 0)
    length, wide = sqrt(2.0) * kernel.lengthscale, filled(n, LANES)
    prior = np.zeros(share) if kernel.prior is None else kernel.prior
    pieces = [
        np.array([variance.identity, variance.limit]),
        prior,
        scaling.shift,
        scaling.scale * length,
        side_by_side(kernel.points / length),
        _row(variance.spectrum, filled(rank, UNROLL)),
        _sheet(kernel.weights.T, filled(share, UNROLL), wide),
        _sheet(variance.vectors, filled(rank, UNROLL), wide),
    ]
    return np.concatenate([piece.ravel() for piece in pieces])


def _row(values: Array, length: int) -> Array:
    """Fill up values (n,) with zeros to a length."""
    return np.pad(values.astype(np.float64), (0, length - len(values)))


def _sheet(matrix: Array, rows: int, columns: int) -> Array:
    """Fill up a matrix with zeros to a number of rows and columns."""
    return np.pad(matrix, ((0, rows - matrix.shape[0]), (0, columns - matrix.shape[1])))


def _header(kind: float, features: FeatureSettings, points: int, outputs: int, count: int) -> Array:
    """Header (HEADER,) of an exported residual, see `layout`."""
    header = np.zeros(HEADER)
    header[[FORMAT, KIND, BLOCKS]] = VERSION, kind, blocks_code(features)
    header[[WIDTH, POINTS, OUTPUTS, COUNT]] = len(feature_names(features)), points, outputs, count
    return header
