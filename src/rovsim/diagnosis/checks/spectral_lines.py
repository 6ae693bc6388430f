"""Pushes that come back: spectral lines, alone or with overtones, even or growing with speed²."""

from dataclasses import dataclass
from typing import Callable, Iterator, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.stats import chi2

from rovsim import AXES
from rovsim.diagnosis.checks.residual import FALSE_ALARM, AxisResidual, Structure
from rovsim.diagnosis.observer.kalman import AxisFilter
from rovsim.diagnosis.observer.observed_run import ObservedRun

HIGHEST = 5.0  # Hz; above it the vehicle's inertia leaves nothing to see
COMBS = ((1,), (1, 2, 3), (1, 3, 5))  # overtones: a sine, a saw tooth, a square wave

Envelope = Callable[[ObservedRun], Array]


@dataclass(frozen=True, eq=False)
class Periodogram:
    """Chi-square (f,) of each `frequency` (f,) Hz in all runs, whatever its phase in each.

    `usable` (u,) frequencies may be the lowest of a comb; `samples` their number, by weight.
    """

    power: Array
    frequency: Array
    usable: Array
    samples: float


def find_lines(residual: AxisResidual) -> Iterator[Structure]:
    """One frequency for all runs, with or without overtones; perhaps growing with speed squared."""
    for growth, envelope in ENVELOPES.items():
        spectrum = _measure_power(residual, envelope)
        for comb in COMBS:
            yield from _judge_comb(residual, spectrum, comb, growth)


def _judge_comb(
    residual: AxisResidual, spectrum: Periodogram, comb: Sequence[int], growth: str
) -> Iterator[Structure]:
    """The strongest fundamental with these overtones."""
    within = spectrum.usable[spectrum.usable * comb[-1] < len(spectrum.power)]
    statistic = sum(spectrum.power[m * within] for m in comb)
    best = int(np.argmax(statistic))
    k = within[best]
    looks = len(spectrum.usable) * len(COMBS) * len(ENVELOPES) * len(AXES)
    limit = chi2.isf(FALSE_ALARM / looks, 2 * len(comb) * len(residual.runs))
    size = _push_power(spectrum, [m * k for m in comb], residual.filters[0], residual.runs[0])
    overtones = ", with overtones" if len(comb) > 1 else ""
    yield from residual.weigh(
        f"a period of {1.0 / spectrum.frequency[k]:.3g} s{overtones}{growth}",
        size=np.sqrt(size), statistic=statistic[best], limit=limit,
    )  # fmt: skip


def _push_power(
    spectrum: Periodogram, lines: Sequence[int], f: AxisFilter, run: ObservedRun
) -> float:
    """Mean square of the push, m2/s4 or rad2/s4, whose lines these are in the innovations."""
    b, a = f.response
    total = 0.0
    for k in lines:
        z = np.exp(2j * np.pi * spectrum.frequency[k] * run.period)
        seen = abs(np.polyval(b, z) / np.polyval(a, z)) ** 2
        total += spectrum.power[k] / spectrum.samples / seen
    return total


def _measure_power(residual: AxisResidual, envelope: Envelope) -> Periodogram:
    period = residual.runs[0].period
    longest = max(run.time[-1] for run in residual.runs)
    count = int(longest / period) + 1
    frequency = np.arange(count + 1) / (2 * count * period)
    usable = np.flatnonzero((frequency >= 1.0 / longest) & (frequency <= HIGHEST))
    envelopes = [envelope(run) for run in residual.runs]
    each = zip(residual.white, envelopes, residual.runs, strict=True)
    power = sum(
        2.0 * np.abs(_transform(w * e, run, count)) ** 2 / np.sum(e**2) for w, e, run in each
    )
    return Periodogram(power, frequency, usable, sum(float(np.sum(e**2)) for e in envelopes))


def _transform(w: Array, run: ObservedRun, count: int) -> Array:
    """Fourier sums on the run's own clock, twice as dense as its length gives."""
    full = np.zeros(2 * count)
    full[np.round(run.time[run.settled] / run.period).astype(int) % (2 * count)] = w
    return np.fft.rfft(full)


def _even(run: ObservedRun) -> Array:
    return np.ones(run.settled.sum())


def _speed_squared(run: ObservedRun) -> Array:
    """Speed squared at the settled readings, of unit mean square."""
    at = np.clip(run.index[run.settled], 0, len(run.motion.time) - 1)
    found = np.sum(np.nan_to_num(run.motion.state_nu[at, :3]) ** 2, axis=1)
    return found / np.sqrt(np.mean(found**2))


ENVELOPES: dict[str, Envelope] = {"": _even, ", growing with speed squared": _speed_squared}
