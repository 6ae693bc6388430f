"""What the motion capture does to the poses it reports: does its software smooth them?

Above some Hz a vehicle stands still, and what is left in the poses is the noise of the cameras. It
is white, unless the software smooths: then it falls off as the software's filter does, and where
that is tells the cutoff. Fitted by Whittle's likelihood of averaged periodograms (Whittle 1953;
Welch 1967), under the exact response of two equal first-order low-passes.
"""

from dataclasses import dataclass
from typing import Sequence

import numpy as np
from numpy import ndarray as Array
from scipy.optimize import minimize, minimize_scalar
from scipy.signal import welch

from rovsim.core.rotations import body_rates
from rovsim.diagnosis.observer.observed_run import ObservedRun
from rovsim.dynamics.effects.pose_filter import PoseFilter
from rovsim.dynamics.low_pass import LowPass
from rovsim.dynamics.model import Model

LOWEST = 5.0  # Hz; above it the vehicle's inertia leaves nothing to see
SEGMENT = 2.56  # s of each periodogram
FEWEST = 8  # frequencies, to tell a shape
SURE = 30.0  # in twice the log likelihood: odds of a million to one, for no effect depends on it
KNOWN = 0.15  # of the cutoff: software at 6 Hz is known to 0.03 of it in four minutes
SLOWEST, FASTEST = 0.5, 0.5  # Hz, and of the highest frequency there is: what can be told
STEP = 0.05  # of the logarithm, for the curvature
# What is left of the motion falls off at least as fast as a force without memory moves a mass; the
# slow error of a camera, with the second power, lies below it.
STEEP = 4.0
NOTHING, MUCH = 1e-8, 1e8  # power of a part beside the noise
ROUNDED = 0.03  # the same at most, of poses written in units of up to 0.6 of the noise: 0.6^2 / 12


@dataclass(frozen=True)
class Smoothing:
    """A software filter: `cutoff` Hz and its standard deviation, `gain` in twice the likelihood."""

    cutoff: float
    std: float
    gain: float


@dataclass(frozen=True, eq=False)
class _Spectrum:
    """Mean periodograms `power` (channels, f) at `frequency` (f,) Hz of frames `period` s apart.

    Each is the mean of `count` independent ones.
    """

    power: Array
    frequency: Array
    count: float
    period: float

    def response(self, cutoff: float) -> Array:
        """Power (f,) that the filter lets through."""
        low_pass = LowPass(PoseFilter(cutoff=cutoff).time_constants())
        return low_pass.pass_power(self.frequency, self.period)

    def cost(self, cutoff: float | None) -> float:
        """Negative log likelihood of noise that was smoothed; None: of noise that was not."""
        motion = (self.frequency / self.frequency[0]) ** -STEEP
        noise, others, most = np.ones_like(motion), [motion], [MUCH]
        if cutoff is not None:
            noise = self.response(cutoff)
            others, most = [noise * motion, np.ones_like(motion)], [MUCH, ROUNDED]
        each = (_misfit(power, noise, np.array(others), most) for power in self.power)
        return self.count * sum(each)


def _misfit(power: Array, noise: Array, others: Array, most: Sequence[float]) -> float:
    """Whittle's cost, least over sizes, of a periodogram (f,) of noise and other parts (k, f).

    `most` (k,): how large these may be beside the noise.
    """

    def cost(x: Array) -> tuple[float, Array]:
        parts = np.exp(x)[:, None] * others
        shape = noise + np.sum(parts, axis=0)
        ratio = power / shape
        size = np.mean(ratio)  # the likeliest
        slope = np.sum(parts / shape * (1.0 - ratio / size), axis=1)
        return float(np.sum(np.log(shape)) + len(power) * np.log(size)), slope

    bounds = [(np.log(NOTHING), np.log(one)) for one in most]
    start = [0.5 * (low + high) for low, high in bounds]
    least = minimize(cost, start, jac=True, method="L-BFGS-B", bounds=bounds)
    return float(least.fun)


def find_smoothing(base: Model, runs: Sequence[ObservedRun]) -> Smoothing | None:
    """The filter that poses were reported through, beside what the base knows; None: none."""
    cameras = [run for run in runs if not run.motion.binned and run.motion.measured is None]
    spectra = [s for run in cameras for s in _measure(base, run)]
    if not spectra:
        return None

    def cost(x: float) -> float:
        return sum(s.cost(float(np.exp(x))) for s in spectra)

    highest = FASTEST * min(float(s.frequency[-1]) for s in spectra)
    best = minimize_scalar(
        cost, bounds=(np.log(SLOWEST), np.log(highest)), method="bounded", options={"xatol": 1e-3}
    )
    x, least = float(best.x), float(best.fun)
    gain = 2.0 * (sum(s.cost(None) for s in spectra) - least)
    bend = (cost(x + STEP) + cost(x - STEP) - 2.0 * least) / STEP**2
    if gain < SURE or bend <= 0.0 or np.exp(x) > 0.98 * highest:
        return None
    found = Smoothing(float(np.exp(x)), float(np.exp(x) / np.sqrt(bend)), gain)
    # far below what is looked at a filter only makes the motion fall off more steeply, as it does
    # by itself where a vehicle tumbles: its cutoff is then hardly known
    return found if found.std < KNOWN * found.cutoff else None


def _measure(base: Model, run: ObservedRun) -> list[_Spectrum]:
    """Spectra of the noise of a run's frames, from its longest stretch."""
    motion, period = run.motion, run.frame_period
    a, b = max(motion.segments(), key=lambda one: one[1] - one[0], default=(0, 0))
    length = round(SEGMENT / period)
    if b - a < 2 * length or 0.5 / period < 2.0 * LOWEST:
        return []
    eta = base.mocap_view.sharpen(run.frames[a:b, :7], period)
    twice = np.diff(eta, 2, axis=0)  # what the vehicle does is slow, so little of it stays
    channels = np.hstack([twice[:, :3], body_rates(eta[1:-1, 3:], twice[:, 3:])]).T
    frequency, power = welch(channels, 1.0 / period, nperseg=length)
    differenced = np.abs(1.0 - np.exp(-2j * np.pi * frequency * period)) ** 4
    kept = (frequency >= LOWEST) & (frequency < 0.96 * frequency[-1])
    if kept.sum() < FEWEST:
        return []
    # half overlapping Hann windows: 0.95 of an independent one each (Welch 1967, eq. 12 f.)
    count = 0.95 * (2.0 * (b - a) / length - 1.0)
    return [_Spectrum(power[:, kept] / differenced[kept], frequency[kept], count, period)]
