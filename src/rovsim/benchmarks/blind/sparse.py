"""The baseline: sparse regression of the acceleration residual, with the optimizers of PySINDy.

STLSQ: sequentially thresholded least squares (Brunton, Proctor & Kutz 2016). FROLS: forward
regression, orthogonal least squares (Billings 2013). Each axis is one regression; an effect is
named if one of its columns is active on any axis. Neither method can say that something is left
unexplained.
"""

import warnings
from contextlib import contextmanager
from pathlib import Path
from typing import Callable, Iterator

import numpy as np
from numpy import ndarray as Array
from scipy.linalg import LinAlgWarning
from sklearn.exceptions import ConvergenceWarning

from rovsim.application.pipeline.recorded_run import load_campaign_vehicle
from rovsim.benchmarks.blind.library import Problem, problem
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings, clean
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Answer
from rovsim.results.fitted import FittedEffect, FittedValue
from rovsim.simulation.command_columns import mark_angles

Regression = Callable[[Array, Array], Array]

# The best of `rovsim.benchmarks.blind.tuning`, on development seeds (docs/benchmark_blind.md).
THRESHOLD, RIDGE = 0.17, 0.02
MIN_GAIN, MAX_TERMS = 0.05, 8


def stlsq(campaign: Path, out: Path) -> Answer:
    """Answer with what sequentially thresholded least squares selects; `out` is not used."""
    return answer(of_campaign(campaign), thresholded(THRESHOLD, RIDGE))


def frols(campaign: Path, out: Path) -> Answer:
    """Answer with what forward regression selects; `out` is not used."""
    return answer(of_campaign(campaign), forward(MIN_GAIN, MAX_TERMS))


def thresholded(threshold: float, ridge: float) -> Regression:
    """Make STLSQ, which keeps terms of at least `threshold` times the RMS acceleration."""

    def coefficients(X: Array, y: Array) -> Array:
        from pysindy import STLSQ

        with _quietly():
            return STLSQ(threshold=threshold, alpha=ridge, max_iter=30).fit(X, y[:, None]).coef_[0]

    return coefficients


def forward(least_gain: float, most: int) -> Regression:
    """Make FROLS, which adds terms while the next one removes `least_gain` of the variance.

    That is Billings' rule, applied to the optimizer's path. PySINDy's own choice of the length
    (kappa) multiplies by the library's condition number, which is infinite for equivalent terms.

    Args:
        least_gain: share of the variance of the target.
        most: number of terms.
    """

    def coefficients(X: Array, y: Array) -> Array:
        from pysindy import FROLS

        max_terms = min(most, X.shape[1] - 1)
        if not y.any():  # PySINDy would divide by its variance
            return np.zeros(X.shape[1])
        with _quietly():
            optimizer = FROLS(max_iter=max_terms, alpha=1e-9, unbias=False).fit(X, y[:, None])
        length = int(np.argmax(np.append(optimizer.ERR_global[:max_terms, 0] < least_gain, True)))
        return optimizer.history_[length][0]

    return coefficients


@contextmanager
def _quietly() -> Iterator[None]:
    """Suppress PySINDy's warnings that nothing is left or that columns resemble one another."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Sparsity parameter is too big")
        warnings.filterwarnings("ignore", category=ConvergenceWarning)
        warnings.filterwarnings("ignore", category=LinAlgWarning)
        yield


def of_campaign(campaign: Path) -> Problem:
    """Make target and library of the train runs of a campaign."""
    loaded = load_campaign(campaign)
    loaded = mark_angles(loaded, load_campaign_vehicle(loaded))
    runs = [run for run in loaded.runs if run.split == "train"]
    motions = [clean(read_run(loaded, run.id)[0], SignalSettings()) for run in runs]
    return problem(nominal(load_campaign_vehicle(loaded)), motions, built_in())


def answer(given: Problem, regression: Regression) -> Answer:
    """Turn active columns into an answer, effects in the order of the error that they remove."""
    coefficients = by_axis(given, regression)
    gains: dict[str, float] = {}
    for k, column in enumerate(given.columns):
        contribution = given.matrix[:, :, k] * coefficients[:, k]
        residual = given.target - np.einsum("nac,ac->na", given.matrix, coefficients)
        if coefficients[:, k].any():
            gain = float(np.mean((residual + contribution) ** 2) - np.mean(residual**2))
            gains[column.effect] = gains.get(column.effect, 0.0) + gain
    order = sorted(gains, key=lambda name: -gains[name])
    selected = tuple(
        FittedEffect(effect=name, parameters=_parameters(given, coefficients, name))
        for name in order
    )
    return Answer(verdict="missing_effects" if selected else "adequate", selected=selected)


def by_axis(given: Problem, regression: Regression) -> Array:
    """Regress each axis by itself.

    Returns:
        Coefficients (6, c), zero where a column is not active on an axis.
    """
    coefficients = np.zeros(given.matrix.shape[1:])
    n = np.sqrt(len(given.target))
    for axis in range(6):
        X, y = given.matrix[:, axis] / n, given.target[:, axis] / n
        norms = np.linalg.norm(X, axis=0)
        columns = distinct(X, norms)
        if len(columns):
            coefficients[axis, columns] = (
                regression(X[:, columns] / norms[columns], y) / norms[columns]
            )
    return coefficients


def distinct(X: Array, size: Array) -> Array:
    """Select columns that act on an axis and are no multiple of an earlier one.

    PySINDy stops at dependent columns, and on one axis two starts of an effect may do the same.

    Args:
        X: columns (n, c) of the axis.
        size: Euclidean norms (c,) of the columns.

    Returns:
        Indices of the columns.
    """
    active = np.flatnonzero(size > 1e-6 * max(size.max(), 1e-12))
    normalized = X[:, active] / size[active]
    cosines = np.triu(np.abs(normalized.T @ normalized), k=1)
    return active[cosines.max(axis=0, initial=0.0) < 1.0 - 1e-9]


def _parameters(given: Problem, coefficients: Array, name: str) -> dict[str, FittedValue]:
    """Return the parameters of an effect, linear in its coefficients from the defaults.

    A column's coefficient is taken from the axis on which the column acts most.
    """
    declared = {p.name: p for p in built_in()[name].parameters}
    values: dict[str, FittedValue] = {}
    for k, column in enumerate(given.columns):
        weights = coefficients[:, k]
        if column.effect == name and weights.any():
            largest = weights[
                np.argmax(np.abs(weights) * np.linalg.norm(given.matrix[:, :, k], axis=0))
            ]
            for parameter, step in column.step.items():
                fitted, unit = values.get(parameter), declared[parameter].unit
                default = np.nan_to_num(declared[parameter].default)
                value = or_nan(fitted.value) if fitted else default
                values[parameter] = FittedValue(value=float(value + largest * step), unit=unit)
    return values
