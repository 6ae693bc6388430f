"""How likely the spectra of poses are, if the noise of the cameras is of some kind.

Above some Hz a vehicle stands still, and what is left in the poses is the noise of the cameras.
Whittle's likelihood of averaged periodograms (Whittle 1953; Welch 1967).
"""

from dataclasses import dataclass
from itertools import product
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.signal import welch

from rovsim.core.rotations import body_rates
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.low_pass import LowPass
from rovsim.dynamics.model import Model
from rovsim.estimation.kernels.whittle import least_misfit
from rovsim.estimation.observer.observed_run import ObservedRun

MIN_FREQUENCY_HZ = 5.0  # Hz; above it the vehicle's inertia leaves nothing to see
SEGMENT_SECONDS = 2.56  # s of each periodogram
TOP_SHARE = 0.96  # of the highest frequency: Welch's estimate has half the freedom there
MIN_FREQUENCIES = 8  # frequencies, to tell a shape
# What is left of the motion falls off at least as fast as a force without memory moves a mass, or
# as one that thrusters lag.
MOTION_EXPONENTS = (4.0, 6.0)
# s, of errors that last: markers that merge, another choice of cameras. The longest of them fall
# off like a random walk above `MIN_FREQUENCY_HZ`; the shortest are over within two frames of
# 100 Hz.
ERROR_MEMORY_SECONDS = (3600.0, 0.2, 0.06, 0.02)
MIN_POWER_RATIO, MAX_POWER_RATIO = 1e-8, 1e8  # power of a part beside the white noise
# The same at most, of poses written in units of up to 0.6 of the noise: 0.6^2 / 12.
MAX_ROUNDING_RATIO = 0.03


@dataclass(frozen=True)
class NoiseKind:
    """What noise is beside white.

    `memory` in s: an error that lasts, too; None: none. `bridged`: frames lie on straight lines
    between those that were taken, as where these came at uneven times or are missing.
    """

    memory: float | None = None
    bridged: bool = False


NOISE_KINDS = [
    NoiseKind(memory, bridged)
    for memory, bridged in product((None, *ERROR_MEMORY_SECONDS), (False, True))
]


@dataclass(frozen=True, eq=False)
class NoiseSpectrum:
    """Mean periodograms `power` (6, f) of a pose at `frequency` (f,) Hz of frames `period` s apart.

    Each is the mean of `count` independent ones.
    """

    power: Array
    frequency: Array
    count: float
    period: float

    def _response(self, cutoff: float) -> Array:
        """Power (f,) that a filter in the software lets through."""
        low_pass = LowPass(PoseFilter(cutoff=cutoff).time_constants())
        return low_pass.pass_power(self.frequency, self.period)

    def _lasting(self, memory: float) -> Array:
        """Power (f,) of first-order Gauss-Markov noise, white noise that a low-pass made last.

        1 at the first frequency.
        """
        power = LowPass((memory,)).pass_power(self.frequency, self.period)
        return np.asarray(power / power[0])

    def cost(self, kind: NoiseKind, cutoff: float | None) -> float:
        """Minus twice the log likelihood; `cutoff` Hz of the software's filter, None: none."""
        shapes = [
            (self.frequency / self.frequency[0]) ** -exponent for exponent in MOTION_EXPONENTS
        ]
        if kind.memory is not None:
            shapes.append(self._lasting(kind.memory))
        if kind.bridged:  # x in 0 .. 1 of the way: 1 - x (1 - x) (2 - 2 cos), a share of this
            shapes.append(0.5 * (1.0 + np.cos(2.0 * np.pi * self.frequency * self.period)))
        white, largest = np.ones_like(self.frequency), [MAX_POWER_RATIO] * len(shapes)
        if cutoff is not None:
            smoothed = self._response(cutoff)
            shapes = [*(smoothed * shape for shape in shapes), white]
            white, largest = smoothed, [*largest, MAX_ROUNDING_RATIO]
        low, high = np.full(len(shapes), np.log(MIN_POWER_RATIO)), np.log(largest)
        return 2.0 * self.count * least_misfit(self.power, white, np.array(shapes), low, high)

    def penalty(self, kind: NoiseKind) -> float:
        """What its sizes cost beyond those of white noise (Schwarz 1978)."""
        sizes = (kind.memory is not None) + kind.bridged
        return float(np.log(self.count * self.power.shape[1]) * sizes * len(self.power))


def measure_spectra(base: Model, runs: Sequence[ObservedRun]) -> list[NoiseSpectrum]:
    """Spectra of the noise of all runs of motion capture, one for each rate of their frames."""
    cameras = [run for run in runs if not run.motion.binned and run.motion.measured is None]
    spectra = [spectrum for run in cameras if (spectrum := _measure_run(base, run)) is not None]
    groups: dict[tuple[float, int], list[NoiseSpectrum]] = {}
    for spectrum in spectra:
        groups.setdefault((round(spectrum.period, 9), len(spectrum.frequency)), []).append(spectrum)
    return [_pool(group) for group in groups.values()]


def _pool(some: Sequence[NoiseSpectrum]) -> NoiseSpectrum:
    """The mean of spectra at the same frequencies: the cameras are the same in all runs."""
    count = sum(s.count for s in some)
    power = sum(s.count / count * s.power for s in some)
    return NoiseSpectrum(np.asarray(power), some[0].frequency, count, some[0].period)


def _measure_run(base: Model, run: ObservedRun) -> NoiseSpectrum | None:
    """Of a run's frames, from its longest stretch; None where that is too short."""
    motion, period = run.motion, run.frame_period
    a, b = max(motion.segments(), key=lambda one: one[1] - one[0], default=(0, 0))
    if (b - a) * period < 2.0 * SEGMENT_SECONDS or 0.5 / period < 2.0 * MIN_FREQUENCY_HZ:
        return None
    eta = base.mocap_view.sharpen(run.frames[a:b, :7], period)
    differences = np.diff(eta, 2, axis=0)  # what the vehicle does is slow, so little of it stays
    channels = np.hstack([differences[:, :3], body_rates(eta[1:-1, 3:], differences[:, 3:])]).T
    return describe_noise(channels, period)


def describe_noise(channels: Array, period: float) -> NoiseSpectrum | None:
    """Of the second differences (6, n) of a pose; None where frequencies are too few."""
    frequency, power = welch(channels, 1.0 / period, nperseg=round(SEGMENT_SECONDS / period))
    differenced = np.abs(1.0 - np.exp(-2j * np.pi * frequency * period)) ** 4
    band = (frequency >= MIN_FREQUENCY_HZ) & (frequency < TOP_SHARE * frequency[-1])
    if band.sum() < MIN_FREQUENCIES:
        return None
    # half overlapping Hann windows: 0.95 of an independent one each (Welch 1967, eq. 12 f.)
    count = 0.95 * (2.0 * channels.shape[1] * period / SEGMENT_SECONDS - 1.0)
    return NoiseSpectrum(power[:, band] / differenced[band], frequency[band], count, period)
