"""Trained residuals laid out for the kernels of `rovsim.residual.predictor`, and checked."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.errors import BadInput
from rovsim.residual.features import BLOCKS, FeatureSettings, blocks_code, feature_names
from rovsim.residual.predictor import (
    COUNT,
    DISTANCE,
    EXPANSION,
    FORMAT,
    HEADER,
    KIND,
    LANES,
    MOST_NEIGHBOURS,
    NEIGHBOURS,
    OUTPUTS,
    POINTS,
    UNIFORM,
    VERSION,
    WEIGHTING,
    WIDTH,
)
from rovsim.residual.scaling import Scaling

AXES = 6  # outputs: surge, sway, heave, roll, pitch, yaw


@dataclass(frozen=True, eq=False)
class Kernel:
    """sum_i weights_i exp(-|(z - points_i) / lengthscale|^2 / 2) of scaled features z.

    `points` (n, d) in scaled features, `lengthscale` (d,), `weights` (n, outputs of this kernel).
    """

    points: Array
    lengthscale: Array
    weights: Array


def export_neighbours(
    features: FeatureSettings, scaling: Scaling, Z: Array, Y: Array, k: int, weights: str
) -> Array:
    """Mean of the targets Y (n, 6) of the k nearest of the scaled points Z (n, d).

    `weights`: `uniform`, or `distance` (inverse). At equal distance the earlier row counts.
    """
    header = _header(NEIGHBOURS, features, len(Z), k)
    header[WEIGHTING] = DISTANCE if weights == "distance" else UNIFORM
    return np.concatenate([header, scaling.shift, scaling.scale, _blocked(Z), Y.ravel()])


def export_expansion(
    features: FeatureSettings, scaling: Scaling, mean: Array, kernels: Sequence[Kernel]
) -> Array:
    """Mean (6,) plus one shared RBF kernel with six outputs, or six kernels with one each."""
    parts = [_header(EXPANSION, features, len(kernels[0].points), len(kernels)), mean]
    for kernel in kernels:
        length = sqrt(2.0) * kernel.lengthscale
        filled = np.zeros((-(-len(kernel.points) // LANES) * LANES, kernel.weights.shape[1]))
        filled[: len(kernel.points)] = kernel.weights
        parts += [scaling.shift, scaling.scale * length]
        parts += [_blocked(kernel.points / length), filled.ravel()]
    return np.concatenate(parts)


def _header(kind: float, features: FeatureSettings, points: int, count: int) -> Array:
    header = np.zeros(HEADER)
    header[[FORMAT, KIND, BLOCKS]] = VERSION, kind, blocks_code(features)
    header[[WIDTH, POINTS, OUTPUTS, COUNT]] = len(feature_names(features)), points, AXES, count
    return header


def _blocked(points: Array) -> Array:
    """Points (n, d) as (blocks, d, LANES), flat, the last block filled up with zeros."""
    n, d = points.shape
    filled = np.zeros((-(-n // LANES) * LANES, d))
    filled[:n] = points
    return filled.reshape(-1, LANES, d).transpose(0, 2, 1).ravel()


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
    filled = -(-n // LANES) * LANES
    if header[KIND] == NEIGHBOURS and 1 <= count <= min(n, MOST_NEIGHBOURS):
        return HEADER + 2 * d + filled * d + n * m
    if header[KIND] == EXPANSION and count in (1, m) and n >= 1:
        return HEADER + m + count * (2 * d + filled * d + filled * (m // count))
    return 0
