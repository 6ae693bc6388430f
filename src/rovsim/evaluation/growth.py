"""How the velocity error of a model grows with the time since the start of a window."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.axes import AXES
from rovsim.evaluation.error_metrics import root_mean
from rovsim.measurement.signals.measured import blank, find_measured
from rovsim.measurement.signals.motion import Motion
from rovsim.results.base import or_none
from rovsim.results.growth import Curve
from rovsim.simulation.prediction import Prediction
from rovsim.simulation.windows import find_windows, predicted

MAX_BINS = 25  # points of a curve
MIN_BIN_WIDTH_S = 0.2  # s: wider than the spacing of recordings that are means over bins


class GrowthScore:
    """Collects squared velocity errors by the time since the start of a window, over test runs.

    Args:
        horizon: length of the windows, s.
    """

    def __init__(self, horizon: float) -> None:
        self.horizon = horizon
        self._bins = max(1, min(MAX_BINS, round(horizon / MIN_BIN_WIDTH_S)))
        self._edges = np.linspace(0.0, horizon, self._bins + 1)
        self._count, self._squares = np.zeros((self._bins, 6)), np.zeros((self._bins, 6))

    def add(self, motion: Motion, prediction: Prediction) -> None:
        """Add a run with the prediction in its windows; ignore a train run."""
        if motion.run.split != "test":
            return
        age = _age(motion, self.horizon)
        scored = motion.usable & ~np.isnan(prediction.nu).any(axis=1)
        member = np.digitize(age, self._edges) - 1
        scored &= (member >= 0) & (member < self._bins)
        count = np.bincount(member[scored], minlength=self._bins)
        self._count += count[:, None] * find_measured(motion.measured)
        with np.errstate(over="ignore"):  # infinite, if the model diverged
            squares = np.square((prediction.nu - motion.nu)[scored])
        np.add.at(self._squares, member[scored], blank(motion.measured, squares, 0.0))

    @property
    def curve(self) -> Curve:
        """Velocity RMSE of measured axes against time; empty without test runs."""
        filled = np.flatnonzero(self._count.any(axis=1))
        rows = root_mean(self._squares[filled], self._count[filled])
        columns = {a: tuple(map(or_none, row)) for a, row in zip(AXES, rows.T, strict=True)}
        return Curve(horizon_s=tuple(self._edges[filled + 1].tolist()), velocity_rmse=columns)


def _age(motion: Motion, horizon: float) -> Array:
    """Time (n,) of each sample since its window began, s; NaN outside of windows."""
    age = np.full(len(motion.time), np.nan)
    for window in find_windows(motion, horizon):
        at = predicted(motion, window)
        age[at] = motion.time[at] - motion.time[window[0]]
    return age
