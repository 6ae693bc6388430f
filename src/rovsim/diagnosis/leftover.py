"""What is left after the best model: does it still vary with something?

Shapes nobody named push on one axis: functions of state, command, place and time, spectral lines
(also such as grow with speed squared), single kicks. How each would show in the innovations follows
from the filter of its axis. One that explains more than chance allows, and enough to matter, is
physics the catalogue does not have.
"""

from dataclasses import dataclass
from typing import Iterator, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import lfilter
from scipy.stats import chi2

from rovsim import AXES
from rovsim.diagnosis.noise import AxisFilter, Noise, Tuning, characteristic
from rovsim.diagnosis.shapes import shapes
from rovsim.diagnosis.watch import Watch

FALSE_ALARM = 0.002  # of all looks together, for each of the three kinds
MATTERS = 0.25  # of the disturbance's standard deviation: less does not show in any score
HIGHEST = 5.0  # Hz; above it the vehicle's inertia leaves nothing to see
KICKS = (0.2, 1.0)  # s, from a knock to a snag


@dataclass(frozen=True)
class Structure:
    """Something the remainder varies with: axis, what, how large (m/s2 or rad/s2, rms), how sure.

    `share` of the remaining disturbance's power, `surprise` = its chi-square above the limit.
    """

    axis: str
    what: str
    size: float
    share: float
    surprise: float


def leftover(
    white: Sequence[Array],
    J: Sequence[Array],
    watches: Sequence[Watch],
    tunings: Sequence[Tuning],
    noise: Noise,
) -> list[Structure]:
    """Structures beyond chance, the most surprising first.

    Args:
        white: whitened innovations (6, n) of each run, settled ones only.
        J: whitened derivatives (k, 6, n) to what was fitted, whose directions are not judged again.
        watches: the runs.
        tunings: the filters that made them white.
        noise: the noise they stand for.
    """
    found: list[Structure] = []
    for i in range(len(AXES)):
        w = [one[i] for one in white]
        filters = [t.filters[i] for t in tunings]
        level = float(noise.level[i])
        used = np.concatenate([one[:, i] for one in J], axis=1)
        found += _shapes(i, w, used, watches, filters, level)
        for run, watch, f in zip(w, watches, filters, strict=True):
            found += _lines(i, run, watch, f, level)
            found += _kicks(i, run, watch, f, level)
    return sorted(found, key=lambda s: -s.surprise)


def response(f: AxisFilter, period: float) -> tuple[Array, Array]:
    """Filter (b, a) from a push on the axis (m/s2, rad/s2) to its innovations of unit variance.

    C (z I - A)^-1 B = det(z I - A + B C) / det(z I - A) - 1 with A = F (I - K C).
    """
    n = len(f.C)
    A = f.F @ (np.eye(n) - np.outer(f.gain, f.C))
    B = np.array([0.5 * period**2, period, 0.0][-n:])
    a = characteristic(A)
    return (characteristic(A - np.outer(B, f.C)) - a) / np.sqrt(f.variance), a


def seen(push: Array, f: AxisFilter, watch: Watch) -> Array:
    """How a push (n,) on one axis shows in the settled innovations."""
    b, a = response(f, watch.period)
    out = np.empty(len(watch.time))
    for first, last in watch.rows:
        out[first:last] = lfilter(b, a, push[first:last])
    return out[watch.settled]


def _shapes(i, w, used, watches, filters, level) -> Iterator[Structure]:
    """Functions of state, command, place and time, with one factor for all runs."""
    target = np.concatenate(w)
    basis = np.linalg.qr(used.T)[0] if len(used) else np.empty((len(target), 0))
    tables = [shapes(watch) for watch in watches]
    limit = chi2.isf(FALSE_ALARM / (len(AXES) * len(tables[0])), 1)
    for name in tables[0]:
        pushes = [table[name] for table in tables]
        size = np.sqrt(np.mean(np.concatenate(pushes) ** 2))
        column = np.concatenate(
            [seen(p, f, watch) for p, f, watch in zip(pushes, filters, watches, strict=True)]
        )
        own = column - basis @ (basis.T @ column)
        power = float(own @ own)
        if power < 1e-6 * float(column @ column) or size == 0.0:
            continue
        factor = float(own @ target) / power
        yield from _if_matters(i, name, abs(factor) * size, level, factor**2 * power, limit)


def _if_matters(i, what, size, level, statistic, limit) -> Iterator[Structure]:
    if statistic > limit and size > MATTERS * level:
        share = min(1.0, (size / level) ** 2)
        yield Structure(AXES[i], what, float(size), float(share), float(statistic / limit))


def _lines(i, w, watch, f, level) -> Iterator[Structure]:
    """A spectral line of constant strength, and one that grows with speed squared."""
    speed = np.linalg.norm(watch.motion.state_nu[watch.index[watch.settled], :3], axis=1) ** 2
    b, a = response(f, watch.period)
    for envelope, text in ((np.ones(len(w)), ""), (speed / np.sqrt(np.mean(speed**2)), ", growing with speed squared")):
        spectrum = _spectrum(w * envelope, watch)
        frequency = np.arange(len(spectrum)) / (2 * len(spectrum) * watch.period)
        fits = (frequency >= 1.0 / (len(w) * watch.period)) & (frequency <= HIGHEST)
        statistic = np.where(fits, 2.0 * np.abs(spectrum) ** 2 / np.sum(envelope**2), 0.0)
        k = int(np.argmax(statistic))
        z = np.exp(2j * np.pi * frequency[k] * watch.period)
        gain = abs(np.polyval(b, z) / np.polyval(a, z))
        size = np.sqrt(2.0) * abs(spectrum[k]) / np.sum(envelope**2) / max(gain, 1e-12)
        limit = chi2.isf(FALSE_ALARM / (2 * len(AXES) * fits.sum() * RUNS), 2)
        what = f"a period of {1 / frequency[k]:.3g} s in run {watch.motion.run.id}{text}" if k else ""
        yield from _if_matters(i, what, size, level, statistic[k], limit)


RUNS = 2  # looks: every run is searched by itself


def _spectrum(w: Array, watch: Watch) -> Array:
    """Fourier sums on the run's own clock, twice as dense as its length gives."""
    n = int(round(watch.time[-1] / watch.period)) + 1
    full = np.zeros(n)
    full[np.clip(np.round(watch.time[watch.settled] / watch.period).astype(int), 0, n - 1)] = w
    return np.fft.rfft(full, 2 * n)[:n]


def _kicks(i, w, watch, f, level) -> Iterator[Structure]:
    """A push that lasts a moment, at any time."""
    b, a = response(f, watch.period)
    for duration in KICKS:
        n = max(1, round(duration / watch.period))
        template = lfilter(b, a, np.concatenate([np.ones(n), np.zeros(round(2.0 / watch.period))]))
        if len(template) >= len(w):
            continue
        factor = np.correlate(w, template, "valid") / float(template @ template)
        k = int(np.argmax(np.abs(factor)))
        statistic = factor[k] ** 2 * float(template @ template)
        limit = chi2.isf(FALSE_ALARM / (len(KICKS) * len(AXES) * len(factor)), 1)
        at = watch.time[watch.settled][k]
        what = f"a push of {duration:g} s at {at:.1f} s in run {watch.motion.run.id}"
        # one moment counts by its own size, not by its mean over the run
        yield from _if_matters(i, what, abs(factor[k]), 4.0 * level, statistic, limit)
