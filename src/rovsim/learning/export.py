"""Trained residuals laid out for the kernels of `rovsim.dynamics.learned.predictor`, and checked."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.core.errors import BadInput
from rovsim.dynamics.learned.features import FeatureSettings, blocks_code, feature_names
from rovsim.dynamics.learned.layout import (
    BLOCKS,
    COUNT,
    DISTANCE,
    EXPANSION,
    FORMAT,
    HEADER,
    KIND,
    LANES,
    MOST_NEIGHBOURS,
    MOST_POINTS,
    NEIGHBOURS,
    OUTPUTS,
    PASS,
    POINTS,
    RANK,
    SURE,
    UNIFORM,
    VERSION,
    WEIGHTING,
    WIDTH,
    filled,
    tree_levels,
)
from rovsim.learning.posterior_variance import Known
from rovsim.learning.scaling import Scaling
from rovsim.learning.tree import packed_tree, side_by_side

AXES = 6  # outputs: surge, sway, heave, roll, pitch, yaw


@dataclass(frozen=True, eq=False)
class Kernel:
    """sum_i weights_i exp(-|(z - points_i) / lengthscale|^2 / 2) of scaled features z.

    `points` (n, d) in scaled features, `lengthscale` (d,), `weights` (n, outputs of this kernel).
    `prior` (outputs of this kernel,) is the variance before anything was seen and `known` what
    reduces it; without `known` the variance is the prior's and nothing fades.
    """

    points: Array
    lengthscale: Array
    weights: Array
    prior: Array | None = None
    known: Known | None = None


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
        header, scaling.shift, scaling.scale, _sheet(axes, filled(len(axes), PASS), len(axes)),
        tree.boxes, side_by_side(turned[tree.order]),
        _row(tree.order, filled(len(Z), LANES)), Z[tree.order], Y[tree.order],
    ]  # fmt: skip
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
    known = [kernel.known for kernel in kernels if kernel.known]
    header = _header(EXPANSION, features, points, len(mean), len(kernels))
    header[RANK] = max((len(k.spectrum) for k in known), default=0)
    header[SURE] = max((k.sure for k in known), default=0) if fades else 0
    parts = [_part(kernel, scaling, int(header[RANK])) for kernel in kernels]
    return np.concatenate([header, mean, *parts])


def _part(kernel: Kernel, scaling: Scaling, rank: int) -> Array:
    """One kernel, as `layout` orders it."""
    n, share = kernel.weights.shape
    known = kernel.known or Known(0.0, np.zeros(0), np.zeros((0, n)), 0)
    length, wide = sqrt(2.0) * kernel.lengthscale, filled(n, LANES)
    prior = np.zeros(share) if kernel.prior is None else kernel.prior
    pieces = [
        np.array([known.identity, known.limit]), prior, scaling.shift, scaling.scale * length,
        side_by_side(kernel.points / length), _row(known.spectrum, filled(rank, PASS)),
        _sheet(kernel.weights.T, filled(share, PASS), wide),
        _sheet(known.vectors, filled(rank, PASS), wide),
    ]  # fmt: skip
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


def check_exported(data: Any, features: FeatureSettings, where: object) -> Array:
    """Refuse an array that the kernels could not read safely.

    Raises:
        BadInput: wrong type, not finite, sizes that do not fit, or other features than named.
    """
    found = _fault(data, features)
    if found is None:
        return np.ascontiguousarray(data)
    raise BadInput(
        found,
        where=where,
        expected="a residual exported by rovsim, with the features its model file names",
        remedy="Train the residual again.",
    )


def _fault(data: Any, features: FeatureSettings) -> str | None:
    if not isinstance(data, np.ndarray) or data.dtype != np.float64 or data.ndim != 1:
        return "the exported residual is not a flat float64 array"
    if data.size < HEADER or not np.isfinite(data).all():
        return "the exported residual is too short or not finite"
    header = data[:HEADER]
    if header[FORMAT] != VERSION or (header != np.floor(header)).any() or (header < 0).any():
        return "the exported residual has an unknown format"
    if header[BLOCKS] != blocks_code(features) or header[WIDTH] != len(feature_names(features)):
        return "the exported residual sees other features than named"
    if header[OUTPUTS] != AXES or data.size != _size(*header):
        return f"the exported residual's sizes do not fit its {data.size} numbers"
    return None


def _size(*header: float) -> int:
    """Length of an exported array with this header; 0 where no such array can exist."""
    d, n, m, count = (int(header[slot]) for slot in (WIDTH, POINTS, OUTPUTS, COUNT))
    length, wide, rank = filled(n, LANES), filled(d, PASS), filled(int(header[RANK]), PASS)
    if header[KIND] == NEIGHBOURS and 1 <= count <= min(n, MOST_NEIGHBOURS):
        boxes = sum(tree_levels(n)[1:]) * 2 * wide * LANES
        return HEADER + (2 + wide) * d + boxes + length * (wide + 1) + n * (d + m)
    sure = header[SURE] <= header[RANK] <= n <= MOST_POINTS
    if header[KIND] == EXPANSION and count in (1, m) and n >= 1 and sure:
        share = m // count
        sheet = (filled(share, PASS) + rank + wide) * length
        return HEADER + m + count * (2 + share + 2 * d + rank + sheet)
    return 0
