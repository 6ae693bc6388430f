"""Cross-correlation of a measured and a commanded motion: along which axes, and how late."""

from dataclasses import dataclass
from functools import cache
from itertools import permutations, product

import numpy as np
import scipy
from numpy import ndarray as Array
from numpy.lib.stride_tricks import sliding_window_view

from rovsim.measurement.quality import EXCITED
from rovsim.measurement.recording.attitudes import finite_rows
from rovsim.measurement.rough_motion import Velocities
from rovsim.measurement.signals.clock import time_step

REACH = 10.0  # s by which clocks that share a start may differ
SHORTEST = 8.0  # s: over a few swings of a vehicle anything looks like anything
OVERLAP = 0.5  # share of the shorter recording that must lie beside the other
AFTER = 2.0  # s for which a motion goes on after its last command
SPARSE = 1e-9  # of motions of size 1: less is rounding
FEW = 64  # lags up to which plain sums are faster than Fourier transforms
# Mean correlations: of runs with their own commands 0.42 to 0.99, of runs with those of others at
# most 0.30 (public tank runs, practice campaigns: docs/your_own_recordings.md).
MIN_CORRELATION = 0.38
AHEAD = 1.3  # times the correlation of the next best


@dataclass(frozen=True, eq=False)
class CrossCorrelation:
    """Correlations (l, 6, 6) of measured along file axes with commanded along FRD, by lag (l,) s.

    A positive lag: the motion comes after its commands. `excited` (6,): the axes that the commands
    move enough to be seen; `unseen`: whether they move others that nobody measured.
    `strength`: measured over commanded speed, 1 for the right vehicle.
    """

    lag: Array
    correlation: Array
    excited: Array
    strength: float
    unseen: bool = False

    @property
    def overlaps(self) -> bool:
        """Whether enough of both lie beside each other at any lag: else nothing can be said."""
        return bool(self.correlation.any())

    def along(self, axes: Array) -> Array:
        """Mean correlation (l,) over the excited axes, the file's body axes being `axes` (3, 3).

        `axes` takes FRD components into those of the file.
        """
        if not self.excited.any():
            return np.zeros(len(self.lag))
        linear = np.einsum("ij,lij->lj", axes, self.correlation[:, :3, :3])
        # a mirrored body turns the other way about its mirrored axes
        angular = np.einsum("ij,lij->lj", axes * np.linalg.det(axes), self.correlation[:, 3:, 3:])
        return np.hstack([linear, angular])[:, self.excited].mean(axis=1)

    def best(self, axes: Array) -> tuple[float, float]:
        """Highest mean correlation along these axes, and its lag in s."""
        score = self.along(axes)
        k = int(np.argmax(score))
        return float(score[k]), float(self.lag[k] + _vertex(score, k) * (self.lag[1] - self.lag[0]))


def _vertex(score: Array, k: int) -> float:
    """Where between its neighbours the highest value lies, in steps from k."""
    if not 0 < k < len(score) - 1:
        return 0.0
    before, here, after = score[k - 1 : k + 2]
    bend = before - 2.0 * here + after
    return float(0.5 * (before - after) / bend) if bend < -SPARSE else 0.0


@cache
def orientations() -> tuple[tuple[tuple[float, ...], ...], ...]:
    """The 48 matrices that swap and turn axes; those with determinant -1 mirror."""
    found = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            axes = np.zeros((3, 3))
            axes[list(order), range(3)] = signs
            found.append(tuple(map(tuple, axes.tolist())))
    return tuple(found)


def rotations() -> list[Array]:
    """The 24 of them that do not mirror."""
    return [a for o in orientations() if np.linalg.det(a := np.array(o)) > 0]


def cross_correlate(
    measured: Velocities, time: Array, commanded: Array, shift: float = 0.0, reach: float = REACH
) -> CrossCorrelation:
    """Compare measured velocities with commanded ones: see `Commanded`."""
    return Commanded(measured.time, time, commanded, shift, reach).correlate(measured)


class Commanded:
    """Commanded velocities, laid out once for all motions that they are compared with.

    Args:
        clock: (n,) even times of the measured motions in s.
        time: (m,) of the commanded velocities in s.
        commanded: (m, 6) along FRD.
        shift: added to the commanded times first, in s.
        reach: the longest lag in s.
    """

    def __init__(
        self, clock: Array, time: Array, commanded: Array, shift: float = 0.0, reach: float = REACH
    ) -> None:
        self.commanded, step = commanded, time_step(clock)
        count = max(1, int(reach / step))
        first, last = clock[0] - count * step, clock[-1] + count * step
        times = first + step * np.arange(round((last - first) / step) + 1)
        inside = (times >= time[0] + shift) & (times <= time[-1] + shift + AFTER)
        other = np.stack([np.interp(times, time + shift, c) for c in commanded.T], axis=1)
        inside &= finite_rows(other)
        other = np.where(inside[:, None], other - _mean(other[inside]), 0.0)
        # the measured stands `k` steps into the commanded: lag = (count - k) * step
        lags = len(other) - len(clock) + 1
        self.lag = step * (count - np.arange(lags)) + shift
        self.seen = inside.sum()
        laid = _Windows if lags <= FEW else _Spectra
        self.itself, self.squared, self.known = (
            laid(x, len(clock)) for x in (other, other**2, inside[:, None].astype(float))
        )

    def correlate(self, measured: Velocities) -> CrossCorrelation:
        """Compare them with a motion."""
        here = np.isfinite(measured.nu).any(axis=0)
        nu = np.where(here, measured.nu, 0.0)
        table = self._correlations(nu, finite_rows(nu))
        known = np.isfinite(table).all(axis=(1, 2))
        moved = self.commanded.std(axis=0) > EXCITED
        excited = here & moved
        table = np.where(known[:, None, None], table, 0.0)
        strength, unseen = _strength(nu, self.commanded, excited), bool((moved & ~here).any())
        return CrossCorrelation(self.lag[::-1], table[::-1], excited, strength, unseen)

    def _correlations(self, nu: Array, whole: Array) -> Array:
        """Correlations (l, 6, 6) at all lags; NaN where few rows overlap."""
        a = np.where(whole[:, None], nu - _mean(nu[whole]), 0.0)
        seen = whole[:, None].astype(float)
        few = self.known.sums(seen)[:, 0, 0] < OVERLAP * min(whole.sum(), self.seen)
        size = self.known.sums(a**2) * self.squared.sums(seen)
        found = self.itself.sums(a) / np.sqrt(np.maximum(size, SPARSE))
        return np.where(few[:, None, None], np.nan, found)


def _strength(nu: Array, commanded: Array, excited: Array) -> float:
    """How fast the vehicle was, over how fast the commands would make it (body axes apart)."""
    axes = slice(0, 3) if excited[:3].any() else slice(3, 6)
    measured = np.sqrt(np.nansum(np.nanvar(nu[:, axes], axis=0)))
    caused = np.sqrt(np.sum(commanded[:, axes].var(axis=0)))
    return float(measured / max(caused, SPARSE))


class _Windows:
    """Sums of products with every stretch of the columns `long` (m, c), for few lags."""

    def __init__(self, long: Array, short: int) -> None:
        self.rows = np.ascontiguousarray(sliding_window_view(long, short, axis=0))

    def sums(self, short: Array) -> Array:
        """Sums (l, k, c) with the columns of `short` (n, k)."""
        return np.swapaxes(self.rows @ short, 1, 2)


class _Spectra:
    """The same for many lags, by Fourier transforms."""

    def __init__(self, long: Array, short: int) -> None:
        self.lags, self.length = len(long) - short + 1, scipy.fft.next_fast_len(len(long), True)
        self.spectra = scipy.fft.rfft(long, self.length, axis=0)

    def sums(self, short: Array) -> Array:
        """Sums (l, k, c) with the columns of `short` (n, k)."""
        own = np.conj(scipy.fft.rfft(short, self.length, axis=0))
        both = own[:, :, None] * self.spectra[:, None]
        return np.asarray(scipy.fft.irfft(both, self.length, axis=0)[: self.lags])


def _mean(x: Array) -> Array:
    return x.mean(axis=0) if len(x) else np.zeros(x.shape[1])
