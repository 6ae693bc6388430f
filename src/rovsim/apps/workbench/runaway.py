"""Replays that run away: since when, and what of them a chart can show beside a measurement."""

from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.reporting.figures.series import limits
from rovsim.simulation.prediction import Prediction

FASTEST = 30.0  # m/s, rad/s: no underwater vehicle moves like that, a replay that does is lost


def find_divergence(time: Array, predicted: Prediction) -> float | None:
    """When a replay is lost, in s from the start of the run; None: never."""
    diverged = (np.abs(predicted.nu) > FASTEST).any(axis=1)
    return float(time[np.argmax(diverged)] - time[0]) if diverged.any() else None


def tell_divergence(time: Array, predicted: Mapping[str, Prediction]) -> str:
    """Which of the replays diverge, and when, in words; empty where none does."""
    return " ".join(
        f"The replay of {name} diverges{_when(time, prediction, seconds)}."
        for name, prediction in predicted.items()
        if (seconds := find_divergence(time, prediction)) is not None
    )


def _when(time: Array, predicted: Prediction, at: float) -> str:
    """After how long; not where the filter has carried the infinite to the first sample."""
    start = np.argmax(~np.isnan(predicted.nu).any(axis=1))
    if at <= time[start] - time[0]:
        return ": nothing of it can be shown"
    return f" after {at:.1f} s; what leaves the chart is not drawn"


def cut(values: Array, measured: Array) -> Array:
    """Values (n,), NaN where they are too far from the measured ones (n,) to share a chart."""
    reference = np.where(np.isfinite(measured), measured, np.nan)
    low, high = limits(reference, [np.clip(values, -FASTEST, FASTEST)])
    return np.where((values >= low) & (values <= high), values, np.nan)
