"""Test for periodic pushes: spectral lines, with or without overtones.

Their amplitude is constant, or grows with the speed squared. Readings at uneven times have no
Fourier transform, so sines and cosines are fitted (Lomb 1976, Astrophys. Space Sci. 39; Scargle
1982, ApJ 263, eq. 10): of white noise, twice the power is chi-square with two degrees of freedom
at any times of the readings. The sums over readings are computed by a Fourier transform on a clock
so fine that every reading has a step of its own.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable, Iterator, Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.fft import next_fast_len
from scipy.ndimage import median_filter
from scipy.stats import chi2

from rovsim.core.axes import AXES
from rovsim.diagnosis.structure.residual import FALSE_ALARM_RATE, AxisResidual, Structure
from rovsim.estimation.observer.observed_run import ObservedRun

MAX_FREQUENCY_HZ = 5.0  # Hz; above it the vehicle's inertia leaves nothing to see
# s: step of the fine clock. Bins begin at such steps, and frames at 100 Hz are one step apart.
# Where readings lie between steps, a line of 5 Hz loses 0.8 % of its power: sinc(5 * 0.01)^2
# (uniform rounding).
CLOCK_STEP_S = 0.01
# Steps of frequency, two for each that the longest run resolves. A line is compared with the 32
# frequencies on either side, of which it and its leakage fill a few.
MEDIAN_WINDOW_LINES = 65
# Of the largest determinant: with less, sine and cosine are the same column.
MIN_DETERMINANT_SHARE = 1e-6
COMBS = ((1,), (1, 2, 3), (1, 3, 5))  # overtones: a sine, a saw tooth, a square wave

Envelope = Callable[[ObservedRun], Array]


@dataclass(frozen=True, eq=False)
class Periodogram:
    """Lomb-Scargle periodogram of r runs at f frequencies.

    Attributes:
        power: chi-square (r, f) that a line explains in each run, at its best phase there.
        frequency: (f,) Hz, evenly spaced from 0.
        usable: indices (u,) of the frequencies that may be the fundamental of a comb.
        samples: number of all readings, as the sum of the squared envelope.
    """

    power: Array
    frequency: Array
    usable: Array
    samples: float

    @cached_property
    def total(self) -> Array:
        """Chi-square (f,) of all runs together."""
        return np.asarray(np.sum(self.power, axis=0))

    @cached_property
    def beyond_noise(self) -> Array:
        """Chi-square (f,) of all runs, relative to the level of the neighbouring frequencies.

        Noise that is correlated for longer than its model says raises all low frequencies alike,
        and is no line. The level is that of white noise at least, as less is chance.
        """
        k = self.usable[0] if len(self.usable) else 0
        level = np.ones_like(self.total)
        white = chi2.median(2 * len(self.power))
        level[k:] = median_filter(self.total[k:], MEDIAN_WINDOW_LINES) / white
        return np.asarray(self.total / np.maximum(1.0, level))


def find_lines(residual: AxisResidual) -> Iterator[Structure]:
    """Yield periodic pushes beyond chance, for each comb and envelope.

    The frequency is the same in all runs, the phase is not.

    Args:
        residual: what a fit leaves on one axis.
    """
    for growth, envelope in ENVELOPES.items():
        spectrum = _measure_power(residual, envelope)
        for comb in COMBS:
            yield from _judge_comb(residual, spectrum, comb, growth)


def _judge_comb(
    residual: AxisResidual, spectrum: Periodogram, comb: Sequence[int], growth: str
) -> Iterator[Structure]:
    """Yield the strongest fundamental with these overtones, if it is beyond chance.

    Args:
        residual: what a fit leaves on one axis.
        spectrum: of that axis.
        comb: multiples of the fundamental, the fundamental (1) first.
        growth: words that say how the amplitude grows.
    """
    candidates = spectrum.usable[spectrum.usable * comb[-1] < len(spectrum.frequency)]
    beyond_noise = sum(spectrum.beyond_noise[m * candidates] for m in comb)
    k_best = int(np.argmax(beyond_noise))
    k = candidates[k_best]
    tests = len(spectrum.usable) * len(COMBS) * len(ENVELOPES) * len(AXES)
    limit = chi2.isf(FALSE_ALARM_RATE / tests, 2 * len(comb) * len(residual.runs))
    if beyond_noise[k_best] <= limit:
        return
    lines = [m * k for m in comb]
    overtones = ", with overtones" if len(comb) > 1 else ""
    yield from residual.weigh(
        f"a period of {1.0 / spectrum.frequency[k]:.3g} s{overtones}{growth}",
        size=np.sqrt(_disturbance_power(spectrum, lines, residual)),
        statistic=float(np.sum(spectrum.total[lines])),
        limit=limit,
    )


def _disturbance_power(
    spectrum: Periodogram, lines: Sequence[int], residual: AxisResidual
) -> float:
    """Mean square of the push, m2/s4 or rad2/s4, that causes lines in the innovations.

    Args:
        spectrum: of the innovations of one axis.
        lines: indices of the frequencies.
        residual: of that axis, whose filters say how a push shows.
    """
    total = 0.0
    for power, f, run in zip(spectrum.power, residual.filters, residual.runs, strict=True):
        z = np.exp(2j * np.pi * spectrum.frequency[lines] * run.period)
        total += np.sum(power[lines] / abs(f.respond_at(z)) ** 2)
    return float(total / spectrum.samples)


def _measure_power(residual: AxisResidual, envelope: Envelope) -> Periodogram:
    """Compute the periodogram of an axis, for lines whose amplitude follows an envelope."""
    longest = max(run.time[-1] for run in residual.runs)
    highest = 0.5 / min(run.period for run in residual.runs)
    # twice as dense as its length gives
    count = next_fast_len(2 * int(longest / CLOCK_STEP_S + 1.0))
    frequency = np.arange(int(highest * count * CLOCK_STEP_S) + 1) / (count * CLOCK_STEP_S)
    usable = np.flatnonzero((frequency >= 1.0 / longest) & (frequency <= MAX_FREQUENCY_HZ))
    envelopes = [envelope(run) for run in residual.runs]
    times = [run.time[run.settled] for run in residual.runs]
    inputs = zip(residual.white, envelopes, times, strict=True)
    power = np.stack([fit_lines(w, e, t, count)[: len(frequency)] for w, e, t in inputs])
    return Periodogram(power, frequency, usable, sum(float(np.sum(e**2)) for e in envelopes))


def fit_lines(white: Array, envelope: Array, time: Array, count: int) -> Array:
    """Fit a line at each frequency, at its best phase.

    Args:
        white: whitened innovations (n,) of unit variance.
        envelope: relative amplitude (n,) of the line at each.
        time: of each (n,), s.
        count: steps of the fine clock, at least up to the last reading.

    Returns:
        Chi-square (count // 2,) that lines explain; the frequency of line k is
        k / (count CLOCK_STEP_S) Hz.
    """
    at = np.round(time / CLOCK_STEP_S).astype(int)
    weighted, power = np.zeros((2, count))
    np.add.at(weighted, at, white * envelope)
    np.add.at(power, at, envelope**2)
    line = np.fft.fft(weighted)[: count // 2]
    # sums of products of sine and cosine follow from those at zero and at twice the frequency
    power_spectrum = np.fft.fft(power)[(2 * np.arange(count // 2)) % count]
    total = np.sum(power)
    cosine, sine, product = (
        (total + power_spectrum.real) / 2,
        (total - power_spectrum.real) / 2,
        -power_spectrum.imag / 2,
    )
    a, b = line.real, -line.imag
    size = cosine * sine - product**2
    numerator = a**2 * sine + b**2 * cosine - 2.0 * a * b * product
    return np.divide(
        numerator, size, out=np.zeros_like(a), where=size > MIN_DETERMINANT_SHARE * total**2
    )


def _constant(run: ObservedRun) -> Array:
    """Constant amplitude at the settled readings."""
    return np.ones(run.settled.sum())


def _speed_squared(run: ObservedRun) -> Array:
    """Amplitude that grows with the speed squared, at the settled readings; mean square 1."""
    at = np.clip(run.innovation_samples[run.settled], 0, len(run.motion.time) - 1)
    squares = np.sum(np.nan_to_num(run.motion.state_nu[at, :3]) ** 2, axis=1)
    return squares / np.sqrt(np.mean(squares**2))


ENVELOPES: dict[str, Envelope] = {"": _constant, ", growing with speed squared": _speed_squared}
