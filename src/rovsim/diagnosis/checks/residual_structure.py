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
from scipy.stats import binom, chi2, norm

from rovsim import AXES
from rovsim.diagnosis.checks.regressors import evaluate_regressors
from rovsim.diagnosis.observer.kalman import AxisFilter
from rovsim.diagnosis.observer.least_squares import solve
from rovsim.diagnosis.observer.noise import Noise, Tuning
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.actuation import ThrustPath

FALSE_ALARM = 0.002  # of all looks together, for each of the three kinds
MATTERS = 0.25  # of the disturbance's standard deviation: less does not show in any score
HIGHEST = 5.0  # Hz; above it the vehicle's inertia leaves nothing to see
COMBS = ((1,), (1, 2, 3), (1, 3, 5))  # overtones: a sine, a saw tooth, a square wave
KICKS = (0.2, 1.0)  # s, from a knock to a snag
SPIN = 0.3  # s within which propellers and motors follow a command
SUDDEN = 0.2  # s, about what the readings resolve
RARE = 3.5  # standard deviations: once in 2000 Gaussian pushes
UNEVEN = 1.15  # turbulence is not equally strong all the time, nor in all runs


@dataclass(frozen=True)
class Structure:
    """Something the remainder varies with.

    `share` of the remaining disturbance's power, `surprise` = its chi-square above the limit.
    """

    axis: str
    what: str
    share: float
    surprise: float


def find_structure(
    white: Sequence[Array],
    J: Sequence[Array],
    runs: Sequence[ObservedRun],
    tunings: Sequence[Tuning],
    noise: Noise,
    path: ThrustPath,
) -> list[Structure]:
    """Structures beyond chance, the most surprising first.

    Args:
        white: whitened innovations (6, n) of each run, settled ones only.
        J: whitened derivatives (k, 6, n) to what was fitted, whose directions are not judged again.
        runs: the runs.
        tunings: the filters that made them white.
        noise: the noise they stand for.
        path: the model's, from a logged command to its thrust.
    """
    found: list[Structure] = []
    vague = [run.vague(path) for run in runs]
    tables = [evaluate_regressors(run) for run in runs]
    for i in range(len(AXES)):
        filters = [t.filters[i] for t in tunings]
        w = [
            _cleared(x[i], f, run, spans)
            for x, f, run, spans in zip(white, filters, runs, vague, strict=True)
        ]
        level = float(noise.level[i])
        used = np.concatenate([one[:, i] for one in J], axis=1)
        found += _smooth_pushes(i, w, used, tables, runs, filters, level)
        found += _lines(i, w, runs, filters, level)
        found += _sudden(i, w, runs)
        for x, run, f in zip(w, runs, filters, strict=True):
            found += _kicks(i, x, run, f, level)
    return sorted(found, key=lambda s: -s.surprise)


def seen(push: Array, f: AxisFilter, run: ObservedRun) -> Array:
    """How a push (n,) on one axis shows in the settled innovations."""
    b, a = f.response
    out = np.empty(len(run.time))
    for first, last in run.rows:
        out[first:last] = lfilter(b, a, push[first:last])
    return out[run.settled]


def _cleared(w: Array, f: AxisFilter, run: ObservedRun, vague: Array) -> Array:
    """Without what the vehicle did while the log does not say what it was told."""
    if not len(vague):
        return w
    later = np.column_stack([vague[:, 1], vague[:, 1] + SPIN])
    spans = [(run.time > begin) & (run.time <= end) for begin, end in (*vague, *later)]
    columns = np.stack([seen(span.astype(float), f, run) for span in spans])
    return w - solve(columns @ columns.T, columns @ w) @ columns


def _smooth_pushes(i, w, used, tables, runs, filters, level) -> Iterator[Structure]:
    """Functions of state, command, place and time, with one factor for all runs."""
    target = np.concatenate(w)
    basis = np.linalg.qr(used.T)[0] if len(used) else np.empty((len(target), 0))
    limit = chi2.isf(FALSE_ALARM / (len(AXES) * len(tables[0])), 1)
    for name in tables[0]:
        pushes = [table[name] for table in tables]
        size = np.sqrt(np.mean(np.concatenate(pushes) ** 2))
        column = np.concatenate(
            [seen(p, f, run) for p, f, run in zip(pushes, filters, runs, strict=True)]
        )
        own = column - basis @ (basis.T @ column)
        power, whole = float(own @ own), float(column @ column)
        if power < 1e-6 * whole or size == 0.0:
            continue
        factor = float(own @ target) / power
        # only the part counts that no fitted parameter could have taken
        part = abs(factor) * size * np.sqrt(power / whole)
        yield from _if_matters(i, name, part, level, factor**2 * power, limit)


def _if_matters(i, what, size, level, statistic, limit) -> Iterator[Structure]:
    if statistic > limit and size > MATTERS * level:
        share = min(1.0, (size / level) ** 2)
        yield Structure(AXES[i], what, float(share), float(statistic / limit))


def _lines(i, w, runs, filters, level) -> Iterator[Structure]:
    """One frequency for all runs, with or without overtones; perhaps growing with speed squared."""
    period = runs[0].period
    longest = max(run.time[-1] for run in runs)
    count = int(longest / period) + 1
    frequency = np.arange(count + 1) / (2 * count * period)
    usable = np.flatnonzero((frequency >= 1.0 / longest) & (frequency <= HIGHEST))
    for text in ("", ", growing with speed squared"):
        envelopes = [_speed_squared(x) if text else np.ones(x.settled.sum()) for x in runs]
        spectra = [
            _spectrum(x * e, run, count) for x, e, run in zip(w, envelopes, runs, strict=True)
        ]
        power = sum(
            2.0 * np.abs(s) ** 2 / np.sum(e**2) for s, e in zip(spectra, envelopes, strict=True)
        )
        yield from _combs(i, power, frequency, usable, runs, filters, level, text, envelopes)


def _combs(i, power, frequency, usable, runs, filters, level, text, envelopes):
    looks = len(usable) * len(COMBS) * 2 * len(AXES)
    samples = sum(float(np.sum(e**2)) for e in envelopes)
    for comb in COMBS:
        within = usable[usable * comb[-1] < len(power)]
        statistic = sum(power[m * within] for m in comb)
        best = int(np.argmax(statistic))
        k = within[best]
        limit = chi2.isf(FALSE_ALARM / looks, 2 * len(comb) * len(runs))
        b, a = filters[0].response
        size = 0.0
        for m in comb:  # rms of the push, from the power of its lines
            z = np.exp(2j * np.pi * frequency[m * k] * runs[0].period)
            size += power[m * k] / samples / abs(np.polyval(b, z) / np.polyval(a, z)) ** 2
        overtones = ", with overtones" if len(comb) > 1 else ""
        what = f"a period of {1.0 / frequency[k]:.3g} s{overtones}{text}"
        yield from _if_matters(i, what, np.sqrt(size), level, statistic[best], limit)


def _speed_squared(run: ObservedRun) -> Array:
    """Speed squared at the settled readings, of unit mean square."""
    at = np.clip(run.index[run.settled], 0, len(run.motion.time) - 1)
    found = np.sum(np.nan_to_num(run.motion.state_nu[at, :3]) ** 2, axis=1)
    return found / np.sqrt(np.mean(found**2))


def _spectrum(w: Array, run: ObservedRun, count: int) -> Array:
    """Fourier sums on the run's own clock, twice as dense as its length gives."""
    full = np.zeros(2 * count)
    full[np.round(run.time[run.settled] / run.period).astype(int) % (2 * count)] = w
    return np.fft.rfft(full)


def _sudden(i, w, runs) -> Iterator[Structure]:
    """Pushes that come at once: innovations with a heavier tail than any Gaussian disturbance."""
    few = max(1, round(SUDDEN / runs[0].period))
    sums = np.concatenate([_sums(x, few) for x in w])
    # the median is not moved by what is looked for (Gaussian: 0.6745 standard deviations)
    usual = float(np.median(np.abs(sums))) / 0.6745
    count = int(np.sum(np.abs(sums) > RARE * usual))
    limit = binom.isf(FALSE_ALARM / len(AXES), len(sums), 2.0 * norm.sf(RARE / UNEVEN))
    if count > limit:
        what = f"sudden pushes, one in about {len(sums) * SUDDEN / count:.2g} s"
        yield Structure(AXES[i], what, 1.0, count / limit)


def _sums(w: Array, few: int) -> Array:
    return w[: len(w) // few * few].reshape(-1, few).sum(axis=1)


def _kicks(i, w, run, f, level) -> Iterator[Structure]:
    """A single push that lasts a moment, at any time."""
    b, a = f.response
    for duration in KICKS:
        n = max(1, round(duration / run.period))
        template = lfilter(b, a, np.concatenate([np.ones(n), np.zeros(round(2.0 / run.period))]))
        if len(template) >= len(w):
            continue
        power = float(template @ template)
        factor = np.correlate(w, template, "valid") / power
        k = int(np.argmax(np.abs(factor)))
        limit = chi2.isf(FALSE_ALARM / (2 * len(KICKS) * len(AXES) * len(factor)), 1)
        at = run.time[run.settled][k]
        what = f"a push of {duration:g} s at {at:.1f} s in run {run.motion.run.id}"
        # one moment counts by its own size, not by its mean over the run
        yield from _if_matters(i, what, abs(factor[k]), 4.0 * level, factor[k] ** 2 * power, limit)
