"""Bring channels to a uniform clock: interpolate them, or integrate rates and velocities."""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.signals.chosen_channels import noise_density
from rovsim.measurement.signals.resample import find_bridged

MAX_GAP_STEPS = 2.5  # usual steps of a channel: a longer one is a gap
# Shortest and longest time over which the drift of an integral is averaged. Slower than the
# disturbances that a Kalman filter allows for (a second), so that within it the noise is that of
# the integral alone; within a minute.
DRIFT_TIMES_S = (3.0, 60.0)


@dataclass(frozen=True, eq=False)
class OnClock:
    """Brings channels to a uniform clock.

    When rates or velocities are integrated, each sample holds from midway after the previous one
    to midway before the next. Integrals between successive such instants share no sample, so
    their noise is white.

    Attributes:
        clock: times (n,) s, evenly spaced.
        max_gap: longest time between samples that is bridged, s.
    """

    clock: Array
    max_gap: float

    @property
    def step(self) -> float:
        """Step of the clock, s; 1 where it has a single instant."""
        return float(self.clock[1] - self.clock[0]) if len(self.clock) > 1 else 1.0

    def values(self, channel: Channel) -> Array:
        """Interpolate values (n, c) of a channel, each column between its own samples.

        Columns with fewer than two samples are NaN.
        """
        resampled = np.full((len(self.clock), channel.value.shape[1]), np.nan)
        for k, column in enumerate(channel.value.T):
            finite = np.isfinite(column)
            if finite.sum() > 1:
                resampled[:, k] = np.interp(self.clock, channel.time[finite], column[finite])
        return resampled

    def attitudes(self, channel: Channel) -> Array:
        """Interpolate the unit quaternions (n, 4) of a channel."""
        return between(self.clock, channel.time, rotations.continuous(channel.value))

    def bridged(self, channel: Channel) -> Array:
        """Whether each sample (n,) is close enough to where the channel was measured."""
        longest = max(self.max_gap, MAX_GAP_STEPS / (channel.rate or 1.0))
        return find_bridged(channel.time, self.clock, longest)

    def nearest(self, instants: Array) -> Array:
        """Mask (n,) of the clock's samples that are nearest to one of the instants (k,) s."""
        mask = np.zeros(len(self.clock), bool)
        index = np.round((instants - self.clock[0]) / self.step).astype(int)
        mask[index[(index >= 0) & (index < len(mask))]] = True
        return mask

    def sum_up(self, time: Array, rate: Array) -> Array:
        """Integrate rates (m, c) measured at `time` (m,) s to values (n, c); NaN counts as zero.

        The integral is zero half a step before the first rate.
        """
        edges = instants_between(time)
        parts = np.nan_to_num(rate) * np.diff(edges)[:, None]
        total = np.vstack([np.zeros(rate.shape[1]), np.cumsum(parts, axis=0)])
        return np.stack([np.interp(self.clock, edges, column) for column in total.T], axis=1)

    def turn_up(self, channel: Channel, start: Array) -> Array:
        """Integrate a channel of body rates to unit quaternions (n, 4); NaN counts as zero.

        The first of them is `start` (4,).
        """
        edges, rate = instants_between(channel.time), np.nan_to_num(channel.value)
        increments = rotations.exp(rate * np.diff(edges)[:, None])
        q = np.empty((len(edges), 4))
        q[0] = [1.0, 0.0, 0.0, 0.0]
        for k, dq in enumerate(increments):
            q[k + 1] = rotations.multiply(q[k], dq)
        interval = np.clip(np.searchsorted(edges, self.clock, "right") - 1, 0, len(increments) - 1)
        remainder = rotations.exp(rate[interval] * (self.clock - edges[interval])[:, None])
        attitude = rotations.multiply(q[interval], remainder)
        return rotations.multiply(
            rotations.multiply(start, rotations.conjugate(attitude[0])), attitude
        )

    def drift(self, apart: Array, summed: Channel, direct: Channel) -> Array:
        """Estimate the drift (n, c) of an integral from direct readings of the same quantity.

        The noise of the integral accumulates, that of the readings does not: the best smoothing of
        their difference is exponential, with the ratio of the two noise densities as its time
        constant (Wiener). A Gaussian kernel of the same width is used here.

        Args:
            apart: direct reading less integral (m, c), at the times of `direct`.
            summed: the channel that was integrated.
            direct: the channel of direct readings.

        Returns:
            What must be added to the integral; NaN in columns without readings.
        """
        ratio = noise_density(direct) / max(noise_density(summed), 1e-12)
        # a noise density is NaN for two readings: then the shortest time
        width = np.clip(np.nan_to_num(ratio), *DRIFT_TIMES_S)
        sigma = np.sqrt(2.0) * width * (direct.rate or 1.0)
        correction = np.full((len(self.clock), apart.shape[1]), np.nan)
        for k, column in enumerate(apart.T):
            finite = np.isfinite(column)
            if finite.any():
                smooth = scipy.ndimage.gaussian_filter1d(column[finite], sigma, mode="reflect")
                correction[:, k] = np.interp(self.clock, direct.time[finite], smooth)
        return correction


def instants_between(time: Array) -> Array:
    """Edges (m + 1,) s of the intervals for which samples of a rate at `time` (m,) s stand."""
    middle = 0.5 * (time[1:] + time[:-1])
    return np.concatenate([[2.0 * time[0] - middle[0]], middle, [2.0 * time[-1] - middle[-1]]])


def between(at: Array, time: Array, q: Array) -> Array:
    """Interpolate sign-continuous quaternions `q` (n, 4) at `time` (n,) to the times `at` (k,).

    Components are interpolated linearly and scaled to unit length (k, 4).
    """
    components = [np.interp(at, time, column) for column in q.T]
    return rotations.normalized(np.stack(components, axis=1))
