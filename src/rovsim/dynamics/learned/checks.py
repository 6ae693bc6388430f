"""Check that kernels can read an exported residual safely, and that features fit it."""

from typing import Any

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.dynamics.learned.layout import (
    BLOCKS,
    COUNT,
    EXPANSION,
    FADING_RANK,
    FORMAT,
    HEADER,
    KIND,
    LANES,
    MAX_NEIGHBOURS,
    MAX_POINTS,
    NEIGHBOURS,
    OUTPUTS,
    POINTS,
    RANK,
    UNROLL,
    VERSION,
    WIDTH,
    filled,
    tree_levels,
)
from rovsim.dynamics.learned.predictor import posterior_many
from rovsim.dynamics.learned.settings import FeatureSettings, blocks_code, feature_names


def check_exported(data: Any, features: FeatureSettings, where: object) -> Array:
    """Check that the kernels can read an array safely; they do not check anything themselves.

    Args:
        data: an exported residual, in the order of `layout`.
        features: that the model file names.
        where: the file, for messages.

    Returns:
        The array, contiguous.

    Raises:
        BadInput: wrong type, not finite, sizes that do not fit, or other features than named.
    """
    fault = _find_fault(data, features)
    if fault is None:
        return np.ascontiguousarray(data)
    raise BadInput(
        fault,
        where=where,
        expected="a residual exported by rovsim, with the features its model file names",
        remedy="Train the residual again.",
    )


def _find_fault(data: Any, features: FeatureSettings) -> str | None:
    """What is wrong with an exported residual, for a message; None if nothing is."""
    if not isinstance(data, np.ndarray) or data.dtype != np.float64 or data.ndim != 1:
        return "the exported residual is not a flat float64 array"
    if data.size < HEADER or not np.isfinite(data).all():
        return "the exported residual is too short or not finite"
    header = data[:HEADER]
    if header[FORMAT] != VERSION or (header != np.floor(header)).any() or (header < 0).any():
        return "the exported residual has an unknown format"
    if header[BLOCKS] != blocks_code(features) or header[WIDTH] != len(feature_names(features)):
        return "the exported residual sees other features than named"
    if header[OUTPUTS] != len(AXES) or data.size != _size(*header):
        return f"the exported residual's sizes do not fit its {data.size} numbers"
    return None


def _size(*header: float) -> int:
    """Number of elements of an exported array with this header; 0 for an impossible header."""
    d, n, m, count = (int(header[slot]) for slot in (WIDTH, POINTS, OUTPUTS, COUNT))
    length, wide, rank = (
        filled(n, LANES),
        filled(d, UNROLL),
        filled(int(header[RANK]), UNROLL),
    )
    if header[KIND] == NEIGHBOURS and 1 <= count <= min(n, MAX_NEIGHBOURS):
        boxes = sum(tree_levels(n)[1:]) * 2 * wide * LANES
        return HEADER + (2 + wide) * d + boxes + length * (wide + 1) + n * (d + m)
    ranked = header[FADING_RANK] <= header[RANK] <= n <= MAX_POINTS
    if header[KIND] == EXPANSION and count in (1, m) and n >= 1 and ranked:
        share = m // count
        sheet = (filled(share, UNROLL) + rank + wide) * length
        return HEADER + m + count * (2 + share + 2 * d + rank + sheet)
    return 0


def posterior(data: Array, X: Array, features: FeatureSettings) -> tuple[Array, Array]:
    """Evaluate mean and variance of an exported Gaussian process, without fading.

    Args:
        data: the exported residual.
        X: unscaled features (n, d).
        features: their settings.

    Returns:
        Mean (n, 6) in m/s2 and rad/s2, and variance (n, 6) in their squares: that of the latent
        function, without the noise of targets.

    Raises:
        BadInput: the residual is no Gaussian process, or X has other columns.
    """
    if has_variance(data):
        return posterior_many(data, checked_rows(X, features))
    raise BadInput(
        "this residual has no variance",
        where="posterior of a residual",
        expected="the residual of a process, such as gp or svgp",
        remedy="Train one, or use predict.",
    )


def has_variance(data: Array) -> bool:
    """Whether an exported residual has a variance beside its mean."""
    return bool(data[KIND] == EXPANSION and data[RANK] > 0.0)


def checked_rows(X: Array, features: FeatureSettings, finite: bool = False) -> Array:
    """Convert features to a contiguous float64 array (n, d), and check its columns.

    Args:
        X: features (n, d).
        features: their settings, which say how many columns there are.
        finite: whether to refuse numbers that are not finite, and arrays without rows.

    Raises:
        BadInput: X has another shape; or, with `finite`, no rows or numbers that are not finite.
    """
    X = np.ascontiguousarray(X, dtype=np.float64)
    d = len(feature_names(features))
    usable = not finite or (len(X) > 0 and np.isfinite(X).all())
    if X.ndim == 2 and X.shape[1] == d and usable:
        return X
    raise BadInput(
        f"features of shape {X.shape}, {np.sum(~np.isfinite(X))} not finite",
        where="features of the residual",
        expected=f"finite rows of {d} ({', '.join(features.blocks)})",
        remedy="Assemble them with the residual's own feature settings, from usable samples.",
    )
