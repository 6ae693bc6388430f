"""Trained residuals laid out for the kernels of `rovsim.dynamics.learned`."""

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
    MOST_POINTS,
    NEIGHBOURS,
    OUTPUTS,
    PASS,
    POINTS,
    RANK,
    UNIFORM,
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
    """sum_i weights_i exp(-|(z - points_i) / lengthscale|^2 / 2) of scaled features z.

    `points` (n, d) in scaled features, `lengthscale` (d,), `weights` (n, outputs of this kernel).
    Of a process, `prior` (outputs of this kernel,) is the variance before anything was seen and
    `variance` what reduces it. Without them the sum has no variance, and nothing fades.
    """

    points: Array
    lengthscale: Array
    weights: Array
    prior: Array | None = None
    variance: PosteriorVariance | None = None


def export_neighbours(
    features: FeatureSettings, scaling: Scaling, Z: Array, Y: Array, k: int, weights: str
) -> Array:
    """Mean of the targets Y (n, m) of the k nearest of the scaled points Z (n, d).

    `weights`: `uniform`, or `distance` (inverse). At equal distance the earlier row counts.
    """
    header = _header(NEIGHBOURS, features, len(Z), Y.shape[1], k)
    header[WEIGHTING] = DISTANCE if weights == "distance" else UNIFORM
    axes = principal_axes(Z)
    turned = Z @ axes.T
    tree = packed_tree(turned)
    parts = [
        header,
        scaling.shift,
        scaling.scale,
        _sheet(axes, filled(len(axes), PASS), len(axes)),
        tree.boxes,
        side_by_side(turned[tree.order]),
        _row(tree.order, filled(len(Z), LANES)),
        Z[tree.order],
        Y[tree.order],
    ]
    return np.concatenate([part.ravel() for part in parts])


def principal_axes(Z: Array) -> Array:
    """Principal axes (d, d) of points (n, d), the widest first."""
    return np.linalg.eigh(np.cov(Z.T, ddof=0).reshape(Z.shape[1], -1))[1].T[::-1]


def export_expansion(
    features: FeatureSettings,
    scaling: Scaling,
    mean: Array,
    kernels: Sequence[Kernel],
    fades: bool = False,
) -> Array:
    """Mean (m,) plus one shared RBF kernel with m outputs, or m kernels with one each.

    Either all kernels have a variance or none.

    Raises:
        BadInput: more points than the kernels have room for.
    """
    points = len(kernels[0].points)
    if points > MOST_POINTS:
        raise BadInput(
            f"{points} points",
            where="kernel expansion of a residual",
            expected=f"at most {MOST_POINTS}",
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
    """One kernel, as `layout` orders it."""
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
        _row(variance.spectrum, filled(rank, PASS)),
        _sheet(kernel.weights.T, filled(share, PASS), wide),
        _sheet(variance.vectors, filled(rank, PASS), wide),
    ]
    return np.concatenate([piece.ravel() for piece in pieces])


def _row(values: Array, length: int) -> Array:
    """Values filled up with zeros to a length."""
    return np.pad(values.astype(np.float64), (0, length - len(values)))


def _sheet(matrix: Array, rows: int, columns: int) -> Array:
    """A matrix filled up with zeros to a size."""
    return np.pad(matrix, ((0, rows - matrix.shape[0]), (0, columns - matrix.shape[1])))


def _header(kind: float, features: FeatureSettings, points: int, outputs: int, count: int) -> Array:
    header = np.zeros(HEADER)
    header[[FORMAT, KIND, BLOCKS]] = VERSION, kind, blocks_code(features)
    header[[WIDTH, POINTS, OUTPUTS, COUNT]] = len(feature_names(features)), points, outputs, count
    return header
