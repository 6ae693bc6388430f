"""Coverage: how much of the measurement lies inside the bands that a model predicts."""

import numpy as np
from numpy import ndarray as Array

from rovsim.measurement.signals.motion import Motion
from rovsim.results.bands import Coverage
from rovsim.results.base import ByAxis
from rovsim.simulation.prediction import Band
from rovsim.simulation.replay import Spans
from rovsim.simulation.windows import last_predicted


def cover(motion: Motion, band: Band, spans: Spans) -> Coverage:
    """Measure how much of the measured velocity of one run lies inside a band.

    Args:
        motion: the run.
        band: of the velocity that the model predicts in the windows.
        spans: of each window, the sample or bin at which it begins, and its end.

    Returns:
        Shares and mean width by axis, over all samples and over the last one of each window.
    """
    finite = np.isfinite(band.nu).all(axis=(0, 2)) & motion.usable
    inside = (motion.nu >= band.nu[0]) & (motion.nu <= band.nu[1])
    ends = last_predicted(motion, spans)
    ends = ends[finite[ends]]
    return Coverage(
        points=int(finite.sum()),
        windows=len(ends),
        inside=ByAxis.of(_mean(inside[finite])),
        at_end=ByAxis.of(_mean(inside[ends])),
        width=ByAxis.of(_mean(band.nu[1, finite] - band.nu[0, finite])),
    )


def _mean(values: Array) -> Array:
    """Mean (6,) over the first axis of `values` (n, 6); NaN where n is zero."""
    return values.mean(axis=0) if len(values) else np.full(6, np.nan)
