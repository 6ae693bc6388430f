"""Errors of a model and metrics of them: one definition of each number, used everywhere."""

from dataclasses import dataclass, fields
from typing import Iterable

import numpy as np
from numpy import ndarray as Array

from rovsim.core.rotations import conjugate, log, multiply
from rovsim.measurement.quality.excitation import MIN_SPREAD
from rovsim.measurement.signals.measured import Measured, blank, find_measured
from rovsim.measurement.signals.motion import Motion
from rovsim.results.base import ByAxis, or_none
from rovsim.results.comparison import Metrics
from rovsim.simulation.prediction import Prediction


@dataclass(frozen=True, eq=False)
class Errors:
    """Model minus measurement of one run, at the samples that both have; NaN where not measured.

    Attributes:
        nu: of the body velocity (n, 6), m/s and rad/s.
        nu_dot: of the body acceleration (m, 6), m/s2 and rad/s2.
        position: distance (n,) of the positions, m.
        attitude: angle (n,) between the attitudes, rad.
        axes: (6,) whose velocity was measured.
        placed: whether the whole position was measured.
        turned: whether the whole attitude was measured.
    """

    nu: Array
    nu_dot: Array
    position: Array
    attitude: Array
    axes: Array
    placed: bool
    turned: bool


def subtract(motion: Motion, prediction: Prediction) -> Errors:
    """Errors of a prediction at all usable samples; infinite or NaN from where it diverged."""
    finite = motion.usable & ~np.isnan(prediction.nu).any(axis=1)
    finite_dot = (
        finite & ~np.isnan(prediction.nu_dot).any(axis=1) & np.isfinite(motion.nu_dot).all(axis=1)
    )
    with np.errstate(invalid="ignore"):
        turn = log(multiply(conjugate(motion.eta[finite, 3:]), prediction.eta[finite, 3:]))
    placed, turned = _find_posed(motion.measured)
    distance = np.linalg.norm(prediction.eta[finite, :3] - motion.eta[finite, :3], axis=1)
    return Errors(
        blank(motion.measured, prediction.nu[finite] - motion.nu[finite], np.nan),
        blank(
            motion.measured,
            prediction.nu_dot[finite_dot] - motion.nu_dot[finite_dot],
            np.nan,
        ),
        np.where(placed, distance, np.nan),
        np.where(turned, np.linalg.norm(turn, axis=1), np.nan),
        find_measured(motion.measured),
        placed,
        turned,
    )


def _find_posed(measured: Measured | None) -> tuple[bool, bool]:
    """Tell whether the whole position, and whether the whole attitude, was measured."""
    if measured is None:
        return True, True
    return bool(measured.coordinates.all()), bool(measured.axes[3:].all())


@dataclass(frozen=True, eq=False)
class ErrorSums:
    """Sums of errors over samples, from which all metrics follow. Sums of several runs add up.

    Attributes:
        samples: number (6,) of samples with a velocity.
        accelerated: number (6,) of samples with an acceleration.
        placed: number of samples with a position.
        turned: number of samples with an attitude.
        nu_squared: sum (6,) of squared velocity errors.
        nu_absolute: sum (6,) of absolute velocity errors.
        nu_dot_squared: sum (6,) of squared acceleration errors.
        position_squared: sum of squared distances, m2.
        attitude_squared: sum of squared angles, rad2.
    """

    samples: Array
    accelerated: Array
    placed: int
    turned: int
    nu_squared: Array
    nu_absolute: Array
    nu_dot_squared: Array
    position_squared: float
    attitude_squared: float

    @staticmethod
    def nothing() -> "ErrorSums":
        """Sums over no samples."""
        no_counts, zero = np.zeros(6, int), np.zeros(6)
        return ErrorSums(no_counts, no_counts, 0, 0, zero, zero, zero, 0.0, 0.0)

    @staticmethod
    def of(errors: Errors) -> "ErrorSums":
        """Sums of the errors of one run."""
        measured = errors.axes
        with np.errstate(over="ignore"):  # the errors of a model that diverged are infinite
            return ErrorSums(
                len(errors.nu) * measured.astype(int),
                len(errors.nu_dot) * measured.astype(int),
                len(errors.position) * int(errors.placed),
                len(errors.attitude) * int(errors.turned),
                np.where(measured, np.square(errors.nu).sum(axis=0), 0.0),
                np.where(measured, np.abs(errors.nu).sum(axis=0), 0.0),
                np.where(measured, np.square(errors.nu_dot).sum(axis=0), 0.0),
                float(np.square(errors.position).sum()) if errors.placed else 0.0,
                float(np.square(errors.attitude).sum()) if errors.turned else 0.0,
            )

    def __add__(self, other: "ErrorSums") -> "ErrorSums":
        pairs = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))
        return ErrorSums(*(a + b for a, b in pairs))

    @property
    def velocity_rmse(self) -> Array:
        """RMS (6,) of the velocity error, m/s and rad/s; NaN on axes without samples."""
        return root_mean(self.nu_squared, self.samples)

    def metrics(self) -> Metrics:
        """The metrics of docs/formats.md; None where the model diverged."""
        return Metrics(
            acceleration_rmse=ByAxis.of(root_mean(self.nu_dot_squared, self.accelerated)),
            velocity_mae=ByAxis.of(_mean(self.nu_absolute, self.samples)),
            velocity_rmse=ByAxis.of(self.velocity_rmse),
            position_rmse_m=or_none(float(root_mean(self.position_squared, self.placed))),
            attitude_rmse_rad=or_none(float(root_mean(self.attitude_squared, self.turned))),
        )


def _mean(total: Array | float, count: Array | int) -> Array:
    """Mean of `count` values that add up to `total`; NaN where the count is zero."""
    nothing = np.full(np.shape(total), np.nan)
    return np.divide(total, count, out=nothing, where=np.asarray(count) > 0)


def root_mean(total: Array | float, count: Array | int) -> Array:
    """Root mean square from a sum of squares `total` (...) over `count`; NaN where count is 0."""
    return np.asarray(np.sqrt(_mean(total, count)))


def rms(x: Array, count: Array | None = None) -> Array:
    """Root mean square of an array (n, ...) over its first axis; NaN for n = 0.

    `count` (...): how many of the n were measured, where all others are zero.
    """
    with np.errstate(over="ignore"):  # infinite, if the model diverged
        return root_mean(np.square(x).sum(axis=0), len(x) if count is None else count)


def compute_metrics(errors: Errors) -> Metrics:
    """Compute the metrics of the errors of one run."""
    return ErrorSums.of(errors).metrics()


@dataclass(frozen=True, eq=False)
class VelocityMoments:
    """Moments of samples on six axes; those of two sets add up.

    Chan, Golub & LeVeque 1983, Am. Stat. 37(3), eq. 2.1.

    Attributes:
        count: number of samples (6,).
        mean: of the samples (6,).
        squares: sum of squared deviations from the mean (6,).
    """

    count: Array
    mean: Array
    squares: Array

    @staticmethod
    def nothing() -> "VelocityMoments":
        """Moments of no samples."""
        return VelocityMoments(np.zeros(6, int), np.zeros(6), np.zeros(6))

    @staticmethod
    def of(motion: Motion) -> "VelocityMoments":
        """Moments of the measured velocity of a run, on the axes that were measured."""
        x = motion.nu[motion.usable]
        mean = x.mean(axis=0) if len(x) else np.zeros(6)
        count = len(x) * find_measured(motion.measured).astype(int)
        return VelocityMoments(count, mean, np.square(x - mean).sum(axis=0))

    def __add__(self, other: "VelocityMoments") -> "VelocityMoments":
        count = self.count + other.count
        share, shift = other.count / np.maximum(count, 1), other.mean - self.mean
        squares = self.squares + other.squares + shift**2 * self.count * share
        return VelocityMoments(count, self.mean + share * shift, squares)

    @property
    def std(self) -> Array:
        """Standard deviation (6,); NaN on axes without samples."""
        return root_mean(self.squares, self.count)


def measured_spread(motions: Iterable[Motion]) -> Array:
    """Standard deviation (6,) of the measured velocity over some runs; NaN on unmeasured axes."""
    return sum(map(VelocityMoments.of, motions), VelocityMoments.nothing()).std


def normalize(spread: Array, velocity_rmse: Array) -> float | None:
    """Velocity RMSE over the standard deviation of the measured velocity, averaged over axes.

    Only axes that were excited count, as one that hardly moved cannot be judged.

    Args:
        spread: standard deviation (6,) of the measured velocity, m/s and rad/s.
        velocity_rmse: (6,), m/s and rad/s.

    Returns:
        The mean; None where no axis was excited, or the model diverged.
    """
    excited = spread > MIN_SPREAD
    return or_none(np.mean(velocity_rmse[excited] / spread[excited])) if excited.any() else None
