"""Cross-correlate measured and commanded velocities: along which axes they agree, and how late."""

from dataclasses import dataclass
from functools import cache
from itertools import permutations, product

import numpy as np
import scipy
from numpy import ndarray as Array
from numpy.lib.stride_tricks import sliding_window_view

from rovsim.measurement.quality.excitation import MIN_SPREAD
from rovsim.measurement.recording.attitudes import finite_rows
from rovsim.measurement.rough_motion import Velocities
from rovsim.measurement.signals.clock import time_step

MAX_CLOCK_OFFSET_S = 10.0  # s by which clocks that share a start may differ
MIN_MOTION_S = 8.0  # s: in less, a vehicle swings so few times that any two motions are correlated
MIN_OVERLAP_SHARE = 0.5  # share of the shorter recording that must overlap with the other
COASTING_S = 2.0  # s for which a motion goes on after its last command
ROUNDING_LIMIT = 1e-9  # of motions of size 1: less is rounding
MAX_DIRECT_LAGS = 64  # lags up to which plain sums are faster than Fourier transforms
# Mean correlation. Runs reach 0.42 to 0.99 with their own commands, and at most 0.30 with those of
# other runs (public tank runs, practice campaigns: docs/your_own_recordings.md).
MIN_CORRELATION = 0.38
MIN_LEAD_RATIO = 1.3  # times the correlation of the next best


@dataclass(frozen=True, eq=False)
class CrossCorrelation:
    """Correlations of measured with commanded velocities at l lags.

    Attributes:
        lag: (l,) s, ascending; positive if the motion comes after its commands.
        correlation: of each measured velocity along the axes of the file with each commanded one
            along FRD, (l, 6, 6).
        excited: mask (6,) of the measured axes that the commands move enough to be seen.
        strength: ratio of measured and commanded speed, about 1 for the right vehicle.
        unseen: whether commands move further axes that nobody measured.
    """

    lag: Array
    correlation: Array
    excited: Array
    strength: float
    unseen: bool = False

    @property
    def overlaps(self) -> bool:
        """Whether the recordings overlap enough at any lag; if not, nothing can be said."""
        return bool(self.correlation.any())

    def along(self, axes: Array) -> Array:
        """Mean correlation (l,) over the excited axes.

        Args:
            axes: matrix (3, 3) that takes FRD components to those along the body axes of the file.
        """
        if not self.excited.any():
            return np.zeros(len(self.lag))
        linear = np.einsum("ij,lij->lj", axes, self.correlation[:, :3, :3])
        # angular velocity is an axial vector: under a mirroring, its sign changes as well
        angular = np.einsum("ij,lij->lj", axes * np.linalg.det(axes), self.correlation[:, 3:, 3:])
        return np.hstack([linear, angular])[:, self.excited].mean(axis=1)

    def best(self, axes: Array) -> tuple[float, float]:
        """Highest mean correlation along axes (3, 3), and its lag in s, interpolated."""
        score = self.along(axes)
        k = int(np.argmax(score))
        return float(score[k]), float(self.lag[k] + _vertex(score, k) * (self.lag[1] - self.lag[0]))


def _vertex(score: Array, k: int) -> float:
    """Offset of the maximum from its sample k, in steps, by a parabola through three samples."""
    if not 0 < k < len(score) - 1:
        return 0.0
    left, middle, right = score[k - 1 : k + 2]
    curvature = left - 2.0 * middle + right
    return float(0.5 * (left - right) / curvature) if curvature < -ROUNDING_LIMIT else 0.0


@cache
def orientations() -> tuple[tuple[tuple[float, ...], ...], ...]:
    """The 48 matrices (3, 3) that permute axes and change signs; half of them mirror."""
    matrices = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            axes = np.zeros((3, 3))
            axes[list(order), range(3)] = signs
            matrices.append(tuple(map(tuple, axes.tolist())))
    return tuple(matrices)


def rotations() -> list[Array]:
    """The 24 of the `orientations` that do not mirror."""
    return [a for o in orientations() if np.linalg.det(a := np.array(o)) > 0]


def cross_correlate(
    measured: Velocities,
    time: Array,
    commanded: Array,
    shift: float = 0.0,
    reach: float = MAX_CLOCK_OFFSET_S,
) -> CrossCorrelation:
    """Correlate measured velocities with commanded ones; for the arguments see `Commanded`."""
    return Commanded(measured.time, time, commanded, shift, reach).correlate(measured)


class Commanded:
    """Commanded velocities, prepared once for all motions that are compared with them.

    Args:
        clock: evenly spaced times (n,) of the measured motions, s.
        time: times (m,) of the commanded velocities, s.
        commanded: velocities (m, 6) FRD, m/s and rad/s.
        shift: added to the commanded times first, s.
        reach: the longest lag, s, beside that shift.
    """

    def __init__(
        self,
        clock: Array,
        time: Array,
        commanded: Array,
        shift: float = 0.0,
        reach: float = MAX_CLOCK_OFFSET_S,
    ) -> None:
        self.commanded, step = commanded, time_step(clock)
        count = max(1, int(reach / step))
        begin, end = clock[0] - count * step, clock[-1] + count * step
        times = begin + step * np.arange(round((end - begin) / step) + 1)
        inside = (times >= time[0] + shift) & (times <= time[-1] + shift + COASTING_S)
        padded = np.stack([np.interp(times, time + shift, c) for c in commanded.T], axis=1)
        inside &= finite_rows(padded)
        padded = np.where(inside[:, None], padded - _mean(padded[inside]), 0.0)
        # measured velocities begin `k` steps after the commanded ones: lag = (count - k) * step
        lags = len(padded) - len(clock) + 1
        self.lag = step * (count - np.arange(lags)) + shift
        self.valid_count = inside.sum()
        kind = _Windows if lags <= MAX_DIRECT_LAGS else _Spectra
        self.itself, self.squared, self.valid = (
            kind(x, len(clock)) for x in (padded, padded**2, inside[:, None].astype(float))
        )

    def correlate(self, measured: Velocities) -> CrossCorrelation:
        """Correlate a measured motion with the commanded velocities."""
        finite = np.isfinite(measured.nu).any(axis=0)
        nu = np.where(finite, measured.nu, 0.0)
        table = self._correlations(nu, finite_rows(nu))
        defined = np.isfinite(table).all(axis=(1, 2))
        driven = self.commanded.std(axis=0) > MIN_SPREAD
        excited = finite & driven
        table = np.where(defined[:, None, None], table, 0.0)
        strength, unseen = (_strength(nu, self.commanded, excited), bool((driven & ~finite).any()))
        return CrossCorrelation(self.lag[::-1], table[::-1], excited, strength, unseen)

    def _correlations(self, nu: Array, whole: Array) -> Array:
        """Correlations (l, 6, 6) at all lags, with the lags descending; NaN where few rows overlap.

        Args:
            nu: measured velocities (n, 6).
            whole: mask (n,) of the rows without unknown values.
        """
        a = np.where(whole[:, None], nu - _mean(nu[whole]), 0.0)
        mask = whole[:, None].astype(float)
        too_short = self.valid.sums(mask)[:, 0, 0] < MIN_OVERLAP_SHARE * min(
            whole.sum(), self.valid_count
        )
        size = self.valid.sums(a**2) * self.squared.sums(mask)
        correlations = self.itself.sums(a) / np.sqrt(np.maximum(size, ROUNDING_LIMIT))
        return np.where(too_short[:, None, None], np.nan, correlations)


def _strength(nu: Array, commanded: Array, excited: Array) -> float:
    """Ratio of the measured speed and the speed that commands would cause, whatever the axes are.

    Linear velocities are compared, or angular ones where no linear axis is excited.
    """
    axes = slice(0, 3) if excited[:3].any() else slice(3, 6)
    motion_std = np.sqrt(np.nansum(np.nanvar(nu[:, axes], axis=0)))
    commanded_std = np.sqrt(np.sum(commanded[:, axes].var(axis=0)))
    return float(motion_std / max(commanded_std, ROUNDING_LIMIT))


class _Windows:
    """Sums of products with columns (m, c) at every lag, by plain sums: fast for few lags.

    Args:
        long: columns (m, c).
        short: length n of the columns that they are multiplied with.
    """

    def __init__(self, long: Array, short: int) -> None:
        self.rows = np.ascontiguousarray(sliding_window_view(long, short, axis=0))

    def sums(self, short: Array) -> Array:
        """Sums (l, k, c) with the columns of `short` (n, k)."""
        return np.swapaxes(self.rows @ short, 1, 2)


class _Spectra:
    """Sums of products with columns (m, c) at every lag, by Fourier transforms: fast for many lags.

    For the arguments see `_Windows`.
    """

    def __init__(self, long: Array, short: int) -> None:
        self.lags, self.length = len(long) - short + 1, scipy.fft.next_fast_len(len(long), True)
        self.spectra = scipy.fft.rfft(long, self.length, axis=0)

    def sums(self, short: Array) -> Array:
        """Sums (l, k, c) with the columns of `short` (n, k)."""
        spectrum = np.conj(scipy.fft.rfft(short, self.length, axis=0))
        products = spectrum[:, :, None] * self.spectra[:, None]
        return np.asarray(scipy.fft.irfft(products, self.length, axis=0)[: self.lags])


def _mean(x: Array) -> Array:
    """Mean of each column of `x` (n, c); zero where n is zero."""
    return x.mean(axis=0) if len(x) else np.zeros(x.shape[1])
