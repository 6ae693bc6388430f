"""Cross-correlation of a measured and a commanded motion: along which axes, and how late."""

from dataclasses import dataclass
from functools import cache
from itertools import permutations, product

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.measurement.quality import EXCITED
from rovsim.measurement.recording.readers import finite_rows
from rovsim.measurement.signals.clock import time_step
from rovsim.measurement.survey.grid import Velocities

REACH = 10.0  # s by which clocks that share a start may differ
SHORTEST = 8.0  # s: over a few swings of a vehicle anything looks like anything
OVERLAP = 0.5  # share of the shorter recording that must lie beside the other
AFTER = 2.0  # s for which a motion goes on after its last command
SPARSE = 1e-9
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
    """Compare measured velocities with commanded ones (m, 6) at times (m,) s, at lags in `reach`.

    `shift` s is added to the commanded times first.
    """
    step = time_step(measured.time)
    count = max(1, int(reach / step))
    first, last = measured.time[0] - count * step, measured.time[-1] + count * step
    clock = first + step * np.arange(round((last - first) / step) + 1)
    inside = (clock >= time[0] + shift) & (clock <= time[-1] + shift + AFTER)
    other = np.stack([np.interp(clock, time + shift, c) for c in commanded.T], axis=1)
    other[~inside] = np.nan
    here = np.isfinite(measured.nu).any(axis=0)
    nu = np.where(here, measured.nu, 0.0)
    whole = np.where(finite_rows(nu)[:, None], nu, np.nan)
    table = _correlations(whole, other)
    # the measured stands `k` steps into the commanded: lag = (count - k) * step
    lags = step * (count - np.arange(len(table)))
    known = np.isfinite(table).all(axis=(1, 2))
    moved = commanded.std(axis=0) > EXCITED
    excited = here & moved
    table = np.where(known[:, None, None], table, 0.0)
    strength, unseen = _strength(nu, commanded, excited), bool((moved & ~here).any())
    return CrossCorrelation(lags[::-1] + shift, table[::-1], excited, strength, unseen)


def _strength(nu: Array, commanded: Array, excited: Array) -> float:
    """How fast the vehicle was, over how fast the commands would make it (body axes apart)."""
    axes = slice(0, 3) if excited[:3].any() else slice(3, 6)
    measured = np.sqrt(np.nansum(np.nanvar(nu[:, axes], axis=0)))
    caused = np.sqrt(np.sum(commanded[:, axes].var(axis=0)))
    return float(measured / max(caused, SPARSE))


def _correlations(a: Array, b: Array) -> Array:
    """Correlations (k, 6, 6) of a (n, 6) with every stretch of b (m, 6); NaN where few overlap."""
    seen_a, seen_b = (np.isfinite(x).all(axis=1).astype(float) for x in (a, b))
    a, b = (np.nan_to_num(x - _mean(x)).T for x in (a, b))
    slide = _Sliding(a.shape[1], b.shape[1])
    once_a, once_b = slide.transform(seen_a), slide.transform(seen_b)
    count = slide.sums(once_a, once_b)
    few = count < OVERLAP * min(seen_a.sum(), seen_b.sum())
    size_a = slide.sums(slide.transform(a**2), once_b)
    size_b = slide.sums(once_a, slide.transform(b**2))
    products = slide.sums(slide.transform(a)[:, None], slide.transform(b)[None])
    found = products / np.sqrt(np.maximum(size_a[:, None] * size_b[None], SPARSE))
    return np.where(few[:, None, None], np.nan, np.moveaxis(found, -1, 0))


@dataclass(frozen=True)
class _Sliding:
    """Sums of products of rows (..., `short`) with every stretch of rows (..., `long`)."""

    short: int
    long: int

    @property
    def _length(self) -> int:
        return int(scipy.fft.next_fast_len(self.short + self.long - 1, real=True))

    def transform(self, x: Array) -> Array:
        """Fourier transform, made once for all that a row is compared with."""
        return np.asarray(scipy.fft.rfft(x, self._length))

    def sums(self, short: Array, long: Array) -> Array:
        """Sums (..., long - short + 1) from the transforms of both."""
        found = scipy.fft.irfft(np.conj(short) * long, self._length)
        return np.asarray(found[..., : self.long - self.short + 1])


def _mean(x: Array) -> Array:
    known = np.isfinite(x).all(axis=1)
    return x[known].mean(axis=0) if known.any() else np.zeros(x.shape[1])
