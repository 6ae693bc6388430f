"""Replays that diverge: since when, and which part of them a chart can show."""

from typing import Mapping

import numpy as np
from numpy import ndarray as Array

from rovsim.reporting.figures.series import limits
from rovsim.simulation.prediction import Prediction

MAX_SPEED = 30.0  # m/s, rad/s: no underwater vehicle moves like that, a replay that does is lost


def find_divergence(time: Array, predicted: Prediction) -> float | None:
    """Return when a replay diverges, s from the start of the run; None: never.

    Args:
        time: of the samples (n,), s.
        predicted: the replay at these.
    """
    diverged = (np.abs(predicted.nu) > MAX_SPEED).any(axis=1)
    return float(time[np.argmax(diverged)] - time[0]) if diverged.any() else None


def tell_divergence(time: Array, predicted: Mapping[str, Prediction]) -> str:
    """Say which of the replays, by name, diverge, and when; empty where none does."""
    return " ".join(
        f"The replay of {name} diverges{_when(time, prediction, seconds)}."
        for name, prediction in predicted.items()
        if (seconds := find_divergence(time, prediction)) is not None
    )


def _when(time: Array, predicted: Prediction, at: float) -> str:
    """Say after how long (`at`, s) a replay diverges, or that no sample of it can be shown.

    That is so where the filter has spread infinite values to the first sample.
    """
    start = np.argmax(~np.isnan(predicted.nu).any(axis=1))
    if at <= time[start] - time[0]:
        return ": nothing of it can be shown"
    return f" after {at:.1f} s; what leaves the chart is not drawn"


def cut(values: Array, measured: Array) -> Array:
    """Return values (n,) with NaN where they are too far from the measured (n,) for one chart."""
    reference = np.where(np.isfinite(measured), measured, np.nan)
    low, high = limits(reference, [np.clip(values, -MAX_SPEED, MAX_SPEED)])
    return np.where((values >= low) & (values <= high), values, np.nan)
