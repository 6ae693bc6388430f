"""Channels on a uniform clock: read between samples, or summed up over them."""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy import ndarray as Array

from rovsim.core import rotations
from rovsim.measurement.recording.channels import Channel
from rovsim.measurement.signals.chosen_channels import noise_density
from rovsim.measurement.signals.resample import find_bridged

LONG = 2.5  # usual steps of a channel: a longer one is a gap
# s, in which a sum may drift. Slower than the disturbances that a filter allows for (a second), so
# that within it the noise is that of the sum alone; within a minute.
DRIFT = (3.0, 60.0)


@dataclass(frozen=True, eq=False)
class OnClock:
    """A uniform clock (n,) s, and the longest gap s that is bridged.

    Each sample of a rate holds from midway to the sample before until midway to the next: sums
    between two such instants share no sample, so that their noise is white.
    """

    clock: Array
    max_gap: float

    @property
    def step(self) -> float:
        """Step of the clock, s."""
        return float(self.clock[1] - self.clock[0]) if len(self.clock) > 1 else 1.0

    def values(self, channel: Channel) -> Array:
        """Values (n, c), each column between its own samples; NaN where none was measured."""
        found = np.full((len(self.clock), channel.value.shape[1]), np.nan)
        for k, column in enumerate(channel.value.T):
            known = np.isfinite(column)
            if known.sum() > 1:
                found[:, k] = np.interp(self.clock, channel.time[known], column[known])
        return found

    def attitudes(self, channel: Channel) -> Array:
        """Unit quaternions (n, 4) of a channel of them."""
        return between(self.clock, channel.time, rotations.continuous(channel.value))

    def bridged(self, channel: Channel) -> Array:
        """Whether each sample (n,) is close enough to where the channel was measured."""
        longest = max(self.max_gap, LONG / (channel.rate or 1.0))
        return find_bridged(channel.time, self.clock, longest)

    def nearest(self, instants: Array) -> Array:
        """Which samples (n,) are the nearest to one of these instants."""
        found = np.zeros(len(self.clock), bool)
        place = np.round((instants - self.clock[0]) / self.step).astype(int)
        found[place[(place >= 0) & (place < len(found))]] = True
        return found

    def sum_up(self, time: Array, rate: Array) -> Array:
        """Integral (n, c) of rates (m, c) measured at `time` (m,); NaN counts as none."""
        edges = instants_between(time)
        parts = np.nan_to_num(rate) * np.diff(edges)[:, None]
        total = np.vstack([np.zeros(rate.shape[1]), np.cumsum(parts, axis=0)])
        return np.stack([np.interp(self.clock, edges, column) for column in total.T], axis=1)

    def turn_up(self, channel: Channel, start: Array) -> Array:
        """Unit quaternions (n, 4) of body rates, from `start` (4,) on; NaN counts as none."""
        edges, rate = instants_between(channel.time), np.nan_to_num(channel.value)
        turns = rotations.exp(rate * np.diff(edges)[:, None])
        q = np.empty((len(edges), 4))
        q[0] = [1.0, 0.0, 0.0, 0.0]
        for k, turn in enumerate(turns):
            q[k + 1] = rotations.multiply(q[k], turn)
        own = np.clip(np.searchsorted(edges, self.clock, "right") - 1, 0, len(turns) - 1)
        rest = rotations.exp(rate[own] * (self.clock - edges[own])[:, None])
        found = rotations.multiply(q[own], rest)
        return rotations.multiply(rotations.multiply(start, rotations.conjugate(found[0])), found)

    def drift(self, apart: Array, summed: Channel, direct: Channel) -> Array:
        """How far (n, c) a sum has drifted, of how far `apart` (m, c) it is from each reading.

        Noise that adds up against noise that does not: the best smoothing is exponential, with the
        ratio of the two as its time (Wiener); here a bell of the same width. NaN without readings.
        """
        ratio = noise_density(direct) / max(noise_density(summed), 1e-12)
        width = np.clip(np.nan_to_num(ratio), *DRIFT)  # two readings: taken as they are
        sigma = np.sqrt(2.0) * width * (direct.rate or 1.0)
        found = np.full((len(self.clock), apart.shape[1]), np.nan)
        for k, column in enumerate(apart.T):
            known = np.isfinite(column)
            if known.any():
                smooth = scipy.ndimage.gaussian_filter1d(column[known], sigma, mode="reflect")
                found[:, k] = np.interp(self.clock, direct.time[known], smooth)
        return found


def instants_between(time: Array) -> Array:
    """Edges (m+1,) of what each sample of a rate at `time` (m,) stands for."""
    middle = 0.5 * (time[1:] + time[:-1])
    return np.concatenate([[2.0 * time[0] - middle[0]], middle, [2.0 * time[-1] - middle[-1]]])


def between(at: Array, time: Array, q: Array) -> Array:
    """Unit quaternions (k, 4) at `at` (k,) of sign-continuous ones (n, 4) at `time` (n,)."""
    each = [np.interp(at, time, column) for column in q.T]
    return rotations.normalized(np.stack(each, axis=1))
